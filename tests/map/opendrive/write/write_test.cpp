#include "roadbed/map/opendrive/write/write.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>

#include "roadbed/map/load_map.h"
#include "roadbed/map/validate_file.h"
#include "roadbed/tests/support/made_lanelet2.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

opendrive::OpenDriveFile file_of(const RoadMap& road_map, int minor = 8) {
  return opendrive::write_open_drive(road_map, {road_map.crs(), {}, minor});
}

double farthest_m(const geometry::Polyline& line, const RoadMap& from, const RoadMap& to,
                  const std::vector<const geometry::Polyline*>& others) {
  double worst_m = 0.0;
  for (const Eigen::Vector2d& point : line.points()) {
    const Eigen::Vector2d at = to.to_map(from.to_source(point));
    double least_m = 1e9;
    for (const geometry::Polyline* other : others) {
      least_m = std::min(least_m, std::abs(other->project(at).d_m));
    }
    worst_m = std::max(worst_m, least_m);
  }
  return worst_m;
}

// The largest distance of a border of `a` to the nearest one of `b`.
double borders_apart_m(const RoadMap& a, const RoadMap& b) {
  std::vector<const geometry::Polyline*> others;
  for (const Lane& lane : b.lanes()) {
    others.push_back(&lane.left.in_map);
    others.push_back(&lane.right.in_map);
  }
  double worst_m = 0.0;
  for (const Lane& lane : a.lanes()) {
    if (!is_drivable(lane.type)) continue;
    for (const LaneLine* line : {&lane.left, &lane.right}) {
      worst_m = std::max(worst_m, farthest_m(line->in_map, a, b, others));
    }
  }
  return worst_m;
}

std::set<LaneId> lanes_at(const RoadMap& from, const RoadMap& to, const Lane& lane, double s_m) {
  const geometry::Pose2 pose = lane.pose_at(s_m);
  std::set<LaneId> found;
  for (const LaneMatch& match : to.locate(to.to_map(from.to_source(pose.position())), 0.01, true)) {
    if (std::cos(match.heading_rad - pose.heading_rad) > 0.9) found.insert(match.place.lane);
  }
  return found;
}

// Whether any of some lanes leads to any of others, over short ones in between.
bool leads(const RoadMap& road_map, std::set<LaneId> lanes, const std::set<LaneId>& others) {
  for (int step = 0; step < 5; ++step) {
    std::set<LaneId> next;
    for (const LaneId id : lanes) {
      if (others.contains(id)) return true;
      const auto& successors = road_map.graph().of(id).successors;
      next.insert(successors.begin(), successors.end());
    }
    lanes = std::move(next);
  }
  return false;
}

// How many links of drivable lanes have no counterpart.
int lost_links(const RoadMap& before, const RoadMap& after) {
  int lost = 0;
  for (const Lane& lane : before.lanes()) {
    if (!is_drivable(lane.type)) continue;
    for (const LaneId id : before.graph().of(lane.id).successors) {
      const Lane& next = before.lane(id);
      if (!is_drivable(next.type)) continue;
      const auto from = lanes_at(before, after, lane, 0.7 * lane.length_m());
      const auto to = lanes_at(before, after, next, 0.3 * next.length_m());
      lost += leads(after, from, to) ? 0 : 1;
    }
  }
  return lost;
}

double drivable_length_m(const RoadMap& road_map) {
  double sum_m = 0.0;
  for (const Lane& lane : road_map.lanes()) sum_m += is_drivable(lane.type) ? lane.length_m() : 0.0;
  return sum_m;
}

void expect_comes_back(const RoadMap& before, int minor) {
  const opendrive::OpenDriveFile file = file_of(before, minor);
  EXPECT_LE(file.largest_error_m, 0.01);
  const RoadMap after = parse_map(file.bytes, "written.xodr");
  EXPECT_LE(borders_apart_m(after, before), 0.01);
  EXPECT_LE(borders_apart_m(before, after), 0.01);
  EXPECT_EQ(lost_links(before, after), 0);
  EXPECT_NEAR(drivable_length_m(after), drivable_length_m(before),
              0.01 * drivable_length_m(before));
}

TEST(WriteOpenDrive, ATownComesBack) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  for (const int minor : {4, 8}) expect_comes_back(town, minor);
}

TEST(WriteOpenDrive, NoLimitComesBackAsNone) {
  tests::MadeMap made = tests::straight_two_lane_road();
  const double none_mps = std::numeric_limits<double>::infinity();
  made.lane(LaneId{0}).speed_limits = {{0.0, 10.0}, {40.0, none_mps}};
  const RoadMap after = parse_map(file_of(made.build()).bytes, "written.xodr");
  std::vector<double> limits_mps;
  for (const SpeedLimit& limit : after.lane(after.find_lane("1/0/-1").value()).speed_limits) {
    limits_mps.push_back(limit.limit_mps.value());
  }
  EXPECT_EQ(limits_mps, std::vector({10.0, none_mps}));
}

TEST(WriteOpenDrive, ALanelet2CrossingComesBack) {
  expect_comes_back(load_map(tests::data_folder() / "crossing.osm"), 8);
}

// Errors that `validate` finds in what is written.
std::vector<std::string> errors_in(const opendrive::OpenDriveFile& file) {
  const tests::TemporaryFolder folder;
  std::vector<std::string> errors;
  for (const auto& finding : validate_file(folder.write("a.xodr", file.bytes)).findings) {
    if (finding.severity != validation::Severity::error) continue;
    errors.push_back(finding.rule + " " + finding.element + " " + finding.message);
  }
  return errors;
}

// Two lanes along a bend of 60 m, cut four times, 12 m apart, every border somewhere else.
std::string staggered_lanes(std::mt19937& random) {
  constexpr int kBorders = 3, kCuts = 5;
  std::uniform_real_distribution<double> off(-2.5, 2.5);
  tests::MadeLanelet2 made;
  const auto node = [&](double s_m, int border) {
    const double radius_m = 60.0 + 3.5 * border, angle = s_m / 60.0;
    return made.node({1000.0 + radius_m * std::sin(angle), 2000.0 + radius_m * std::cos(angle)});
  };
  std::int64_t ways[kBorders][kCuts - 1];
  for (int border = 0; border < kBorders; ++border) {
    double from_m = 0.0;
    std::int64_t joint = node(from_m, border);
    for (int cut = 1; cut < kCuts; ++cut) {
      const double to_m = 12.0 * cut + (cut + 1 < kCuts ? off(random) : 0.0);
      std::vector<std::int64_t> nodes{joint};
      for (double share = 0.1; share < 0.95; share += 0.1) {
        nodes.push_back(node(from_m + share * (to_m - from_m), border));
      }
      nodes.push_back(joint = node(to_m, border));
      from_m = to_m;
      ways[border][cut - 1] = made.way(nodes, {{"type", "line_thin"}, {"subtype", "dashed"}});
    }
  }
  // Clockwise: the outer border is the left one.
  for (int cut = 0; cut + 1 < kCuts; ++cut) {
    for (int lane = 0; lane + 1 < kBorders; ++lane) {
      made.lanelet(ways[lane + 1][cut], ways[lane][cut],
                   {{"type", "lanelet"}, {"subtype", "road"}, {"one_way", "yes"}});
    }
  }
  return made.text();
}

TEST(WriteOpenDrive, LanesWhoseBordersEndAtDifferentPlacesComeBack) {
  std::mt19937 random(20261125);
  for (int run = 0; run < 20; ++run) {
    SCOPED_TRACE(run);
    const RoadMap before = parse_map(staggered_lanes(random), "staggered.osm");
    ASSERT_EQ(before.lanes().size(), 8u);
    expect_comes_back(before, 8);
    EXPECT_EQ(errors_in(file_of(before)), std::vector<std::string>{});
  }
}

// Lanes of 40 m side by side whose borders end `late_m` after 40 m, or begin so before 0.
RoadMap ending_lanes(const std::vector<double>& late_m, bool at_start) {
  tests::MadeLanelet2 made;
  std::vector<std::int64_t> ways;
  for (std::size_t i = 0; i < late_m.size(); ++i) {
    const double y_m = 4.0 * static_cast<double>(i);
    const double from_m = at_start ? -late_m[i] : 0.0, to_m = at_start ? 40.0 : 40.0 + late_m[i];
    ways.push_back(made.line({{from_m, y_m}, {20, y_m}, {to_m, y_m}}));
  }
  for (std::size_t i = 0; i + 1 < ways.size(); ++i) made.lanelet(ways[i + 1], ways[i]);
  return parse_map(made.text(), "made.osm");
}

TEST(WriteOpenDrive, BordersEndWhereTheMapsEndThoughTheyAreOutOfLine) {
  for (const std::vector<double>& late_m : {std::vector{0.0, 0.0, 0.0},
                                            {0.0, 0.12, 0.0},
                                            {0.1, 0.0, 0.1},
                                            {0.0, 0.2, 0.4},
                                            {1.5, 0.0, 0.0},
                                            {0.0, 0.0, 0.3, 0.0},
                                            {0.3, 0.0, 0.0, 0.9, -0.4}}) {
    SCOPED_TRACE(::testing::PrintToString(late_m));
    for (const bool at_start : {false, true}) {
      const RoadMap before = ending_lanes(late_m, at_start);
      ASSERT_EQ(before.lanes().size(), late_m.size() - 1);
      const opendrive::OpenDriveFile file = file_of(before);
      const RoadMap after = parse_map(file.bytes, "written.xodr");
      EXPECT_LE(borders_apart_m(before, after), 0.01);
      EXPECT_LE(borders_apart_m(after, before), 0.01);
      EXPECT_LE(file.largest_error_m, 0.01);
      EXPECT_EQ(file.notes, std::vector<std::string>{});
      EXPECT_EQ(errors_in(file), std::vector<std::string>{});
      EXPECT_NEAR(drivable_length_m(after), drivable_length_m(before),
                  0.03 * drivable_length_m(before));
    }
  }
}

TEST(WriteOpenDrive, LanesMeetWhereTheMapLeavesAGap) {
  for (const double gap_m : {0.05, 0.15, 0.25}) {
    tests::MadeLanelet2 made;
    const auto line = [&](double from_m, double to_m, double y_m) {
      return made.line({{from_m, y_m}, {0.5 * (from_m + to_m), y_m}, {to_m, y_m}});
    };
    const std::int64_t right = made.node({0, 0}), joint = made.node({30, 0});
    const std::int64_t end = made.node({60, 0});
    made.lanelet(line(0, 30, 4), made.way({right, joint}));
    made.lanelet(line(30, 60, 4 + gap_m), made.way({joint, end}));
    const RoadMap before = parse_map(made.text(), "made.osm");
    const opendrive::OpenDriveFile file = file_of(before);
    EXPECT_LE(file.largest_error_m, gap_m + 0.01);
    const RoadMap after = parse_map(file.bytes, "written.xodr");
    const double apart_m = std::max(borders_apart_m(before, after), borders_apart_m(after, before));
    EXPECT_NEAR(file.largest_error_m, apart_m, 1e-3);
    ASSERT_EQ(after.lanes().size(), 2u);
    for (const Lane& lane : after.lanes()) {
      for (const LaneId next : after.graph().of(lane.id).successors) {
        for (const auto border : {&Lane::left, &Lane::right}) {
          const Eigen::Vector2d& from = (lane.*border).in_map.points().back();
          const Eigen::Vector2d& to = (after.lane(next).*border).in_map.points().front();
          EXPECT_LE((to - from).norm(), 1e-3);
        }
      }
    }
  }
}

/// Lanes of 3.5 m between ways that share the nodes at their ends.
class GateLanes {
 public:
  using Gate = std::pair<std::int64_t, std::int64_t>;  ///< left, right

  Gate gate(tests::MadeLanelet2::Point left, tests::MadeLanelet2::Point right) {
    return {made_.node(left), made_.node(right)};
  }

  void lane(const Gate& from, const std::vector<tests::MadeLanelet2::Point>& left,
            const std::vector<tests::MadeLanelet2::Point>& right, const Gate& to,
            const tests::MadeLanelet2::Tags& tags = {{"subtype", "road"}, {"one_way", "yes"}}) {
    lanelet(way(from.first, left, to.first), way(from.second, right, to.second), tags);
  }

  void lanelet(std::int64_t left, std::int64_t right,
               const tests::MadeLanelet2::Tags& tags = {{"subtype", "road"}, {"one_way", "yes"}}) {
    made_.lanelet(left, right, tags);
  }

  RoadMap road_map() const { return parse_map(made_.text(), "made.osm"); }

  std::int64_t way(std::int64_t from, const std::vector<tests::MadeLanelet2::Point>& between,
                   std::int64_t to) {
    std::vector<std::int64_t> nodes{from};
    for (const auto& point : between) nodes.push_back(made_.node(point));
    nodes.push_back(to);
    return made_.way(nodes);
  }

 private:
  tests::MadeLanelet2 made_;
};

TEST(WriteOpenDrive, LanesThatFaceEachOtherKeepTheirCorners) {
  // A lane leads over an askew gate into one of both ways, against which another one leads back.
  GateLanes lanes;
  const GateLanes::Gate middle = lanes.gate({1.5, 3.5}, {0, 0});
  lanes.lane(lanes.gate({-30, 3.5}, {-30, 0}), {}, {}, middle);
  lanes.lane(middle, {}, {}, lanes.gate({30, 3.5}, {30, 0}),
             {{"subtype", "road"}, {"one_way", "no"}});
  lanes.lane({middle.second, middle.first}, {}, {}, lanes.gate({-30, -3}, {-30, 0.5}));
  const RoadMap after = parse_map(file_of(lanes.road_map()).bytes, "written.xodr");
  const auto faced = std::ranges::find(after.lanes(), false, &Lane::one_way);
  ASSERT_NE(faced, after.lanes().end());
  const auto corner = [](const LaneLine& line) { return line.in_map.points().front(); };
  EXPECT_TRUE(std::ranges::any_of(after.lanes(), [&](const Lane& lane) {
    return (corner(lane.left) - corner(faced->right)).norm() <= 1e-3 &&
           (corner(lane.right) - corner(faced->left)).norm() <= 1e-3;
  }));
}

std::vector<tests::MadeLanelet2::Point> half_circle(double radius_m) {
  std::vector<tests::MadeLanelet2::Point> points;
  for (double angle = 0.1; angle < 3.1; angle += 0.1) {
    points.emplace_back(radius_m * std::sin(angle), 15.0 - radius_m * std::cos(angle));
  }
  return points;
}

// Two lanes lead to one that goes on and one that turns back, where another one joins it.
RoadMap turning_back() {
  GateLanes lanes;
  const GateLanes::Gate in = lanes.gate({0, 5}, {0, 1.5}), out = lanes.gate({0, 25}, {0, 28.5});
  lanes.lane(lanes.gate({-40, 5}, {-40, 1.5}), {}, {}, in);
  lanes.lane(lanes.gate({-40, -5}, {-40, -8.5}), {{-20, 0}}, {{-20, -3.5}}, in);
  lanes.lane(in, {}, {}, lanes.gate({60, 5}, {60, 1.5}));
  lanes.lane(in, half_circle(10), half_circle(13.5), out);
  lanes.lane(lanes.gate({60, 25}, {60, 28.5}), {}, {}, out);
  lanes.lane(out, {}, {}, lanes.gate({-40, 25}, {-40, 28.5}));
  return lanes.road_map();
}

TEST(WriteOpenDrive, ALaneThatTurnsBackStaysInOnePiece) {
  const auto turning = [](const RoadMap& road_map) {
    return std::ranges::count_if(road_map.lanes(), [](const Lane& lane) {
      return std::cos(lane.pose_at(0.0).heading_rad - lane.pose_at(lane.length_m()).heading_rad) <
             std::cos(2.6);
    });
  };
  const RoadMap before = turning_back();
  ASSERT_EQ(turning(before), 1);
  const opendrive::OpenDriveFile file = file_of(before);
  const RoadMap after = parse_map(file.bytes, "written.xodr");
  EXPECT_EQ(turning(after), 2);  // from each of the lanes that lead to it
  EXPECT_EQ(lost_links(before, after), 0);
  EXPECT_EQ(errors_in(file), std::vector<std::string>{});
}

std::ptrdiff_t begin_nowhere(const RoadMap& road_map) {
  return std::ranges::count_if(road_map.lanes(), [&](const Lane& lane) {
    return is_drivable(lane.type) && road_map.graph().of(lane.id).predecessors.empty();
  });
}

TEST(WriteOpenDrive, NoLaneOfACopyBeginsNowhere) {
  // Two lanes beside each other come from two roads, one of which forks.
  GateLanes lanes;
  const auto [left, middle] = lanes.gate({0, 7}, {0, 3.5});
  const auto [right, end] = lanes.gate({0, 0}, {60, 3.5});
  lanes.lane(lanes.gate({-40, 7}, {-40, 3.5}), {}, {}, {left, middle});
  lanes.lane(lanes.gate({-40, -6}, {-40, -9.5}), {{-20, 0}}, {{-20, -3.5}}, {middle, right});
  lanes.lane({middle, right}, {{20, 1.5}}, {{20, -2}}, lanes.gate({60, -8}, {60, -11.5}));
  const auto [upper, lower] = lanes.gate({60, 7}, {60, 0});
  const std::int64_t between = lanes.way(middle, {}, end);
  lanes.lanelet(lanes.way(left, {}, upper), between);
  lanes.lanelet(between, lanes.way(right, {}, lower));
  const RoadMap before = lanes.road_map();
  ASSERT_EQ(begin_nowhere(before), 2);
  const RoadMap after = parse_map(file_of(before).bytes, "written.xodr");
  EXPECT_EQ(begin_nowhere(after), 2);
  EXPECT_EQ(lost_links(before, after), 0);
}

// A road of one lane that begins along a curve of some length and goes on, and may have a second
// section.
std::string one_lane(const std::string& geometry, double length_m, double offset_m,
                     const std::string& second_section_m = "", double more_m = 0.0) {
  const std::string lane =
      "<center><lane id=\"0\" type=\"none\"/></center><right><lane id=\"-1\" type=\"driving\">"
      "<link><predecessor id=\"-1\"/><successor id=\"-1\"/></link>"
      "<width sOffset=\"0\" a=\"3.2\" b=\"0\" c=\"0\" d=\"0\"/></lane></right></laneSection>";
  std::string lanes = "<laneSection s=\"0\">" + lane;
  if (!second_section_m.empty()) lanes += "<laneSection s=\"" + second_section_m + "\">" + lane;
  return fmt::format(
      "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road id=\"1\" length=\"{4}\" "
      "junction=\"-1\"><planView><geometry s=\"0\" x=\"5\" y=\"7\" hdg=\"0.3\" length=\"{0}\">"
      "{1}</geometry></planView><lanes><laneOffset s=\"0\" a=\"{2}\" b=\"0\" c=\"0\" d=\"0\"/>"
      "{3}</lanes></road></OpenDRIVE>",
      length_m, geometry, offset_m, lanes, length_m + more_m);
}

TEST(WriteOpenDrive, ARoadOfTheMapTurnsBackWhereItDoes) {
  // Tighter than its lane is wide: the inner border runs back in the bend.
  for (const double offset_m : {0.0, 3.2}) {
    const RoadMap before = parse_map(
        one_lane("<paramPoly3 aU=\"0\" bU=\"14.31\" cU=\"-11.45\" dU=\"0\" aV=\"0\" bV=\"0\" "
                 "cV=\"5.72\" dV=\"0\" pRange=\"normalized\"/>",
                 9.45, offset_m),
        "bend.xodr");
    const opendrive::OpenDriveFile file = file_of(before);
    EXPECT_LE(file.largest_error_m, 0.01) << offset_m;
    EXPECT_EQ(file.notes, std::vector<std::string>{});
    const RoadMap after = parse_map(file.bytes, "written.xodr");
    EXPECT_LE(borders_apart_m(before, after), 0.01);
    EXPECT_LE(borders_apart_m(after, before), 0.01);
  }
}

// So that the lane's middle leads back at first.
TEST(WriteOpenDrive, ARoadOfTheMapTurnsBackAsSoonAsItBegins) {
  const RoadMap before = parse_map(
      one_lane("<paramPoly3 aU=\"0\" bU=\"2.588\" cU=\"-1.363\" dU=\"0\" aV=\"0\" bV=\"0\" "
               "cV=\"-4.134\" dV=\"0\" pRange=\"normalized\"/>",
               4.632, 0.0),
      "turn.xodr");
  const opendrive::OpenDriveFile file = file_of(before);
  EXPECT_LE(file.largest_error_m, 0.02);
  EXPECT_LE(borders_apart_m(before, parse_map(file.bytes, "written.xodr")), 0.02);
}

TEST(WriteOpenDrive, ARoadOfTheMapBendsBehindALongStraight) {
  const RoadMap before = parse_map(
      one_lane(
          fmt::format("<paramPoly3 aU=\"0\" bU=\"400\" cU=\"0\" dU=\"0\" aV=\"0\" bV=\"0\" "
                      "cV=\"0\" dV=\"0\" pRange=\"normalized\"/></geometry><geometry s=\"400\" "
                      "x=\"{}\" y=\"{}\" hdg=\"0.3\" length=\"100\"><arc curvature=\"0.01\"/>",
                      5.0 + 400.0 * std::cos(0.3), 7.0 + 400.0 * std::sin(0.3)),
          400.0, 0.0, "450", 100.0),
      "long.xodr");
  const opendrive::OpenDriveFile file = file_of(before);
  EXPECT_LE(file.largest_error_m, 0.003);
  EXPECT_LE(borders_apart_m(before, parse_map(file.bytes, "written.xodr")), 0.003);
}

TEST(WriteOpenDrive, ASectionOfAFewCentimetresStays) {
  const RoadMap before = parse_map(one_lane("<line/>", 10.0, 0.0, "9.96"), "short.xodr");
  ASSERT_EQ(before.lanes().size(), 2u);
  const opendrive::OpenDriveFile file = file_of(before);
  EXPECT_EQ(file.notes, std::vector<std::string>{});
  const RoadMap after = parse_map(file.bytes, "written.xodr");
  ASSERT_EQ(after.lanes().size(), 2u);
  EXPECT_EQ(after.graph().of(LaneId{0}).successors, std::vector{LaneId{1}});
}

TEST(WriteOpenDrive, RealMapsAreWrittenWithoutErrors) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const std::filesystem::path autoware = folder / "lanelet2/autowarefoundation+autoware_core";
  for (const std::filesystem::path& file :
       {autoware / "2km_test.osm", autoware / "intersection.osm", autoware / "road_shoulder.osm",
        autoware / "vm_03_left_hand.osm", folder / "opendrive/esmini+esmini/soderleden.xodr",
        folder / "commonroad/CommonRoad+commonroad-reachable-set/DEU_Guetersloh-20_1_T-1.xml"}) {
    SCOPED_TRACE(file);
    if (!std::filesystem::exists(file)) continue;
    const opendrive::OpenDriveFile written = file_of(load_map(file));
    EXPECT_EQ(errors_in(written), std::vector<std::string>{});
    EXPECT_LE(written.largest_error_m, 0.13);
    for (const auto& [what, count] : written.lost) EXPECT_EQ(what.find("lanes that no"), what.npos);
  }
}

TEST(WriteOpenDrive, NamesALaneThatNoRoadCanHold) {
  tests::MadeLanelet2 made;
  const auto crossing = made.line({{0, 3}, {10, -3}}), straight = made.line({{0, 0}, {10, 0}});
  made.lanelet(crossing, straight);
  made.lanelet(made.line({{0, 20}, {10, 20}}), made.line({{0, 17}, {10, 17}}));
  const RoadMap before = parse_map(made.text(), "made.osm");
  ASSERT_EQ(before.lanes().size(), 2u);
  const opendrive::OpenDriveFile file = file_of(before);
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_TRUE(file.notes[0].starts_with("left out is lane " + before.lanes()[0].name));
  EXPECT_EQ(parse_map(file.bytes, "written.xodr").lanes().size(), 1u);
  EXPECT_EQ(errors_in(file), std::vector<std::string>{});
}

TEST(WriteOpenDrive, WritesTheSameBytesForTheSameMap) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  EXPECT_EQ(file_of(town).bytes, file_of(town).bytes);
}

TEST(WriteOpenDrive, KeepsCoordinatesAndTheirSystem) {
  const RoadMap before = load_map(tests::data_folder() / "town.xodr");
  const RoadMap after = parse_map(file_of(before).bytes, "written.xodr");
  EXPECT_EQ(after.crs(), before.crs());
  EXPECT_EQ(after.format(), "OpenDRIVE 1.8");
}

TEST(WriteOpenDrive, NamesThePlaceInItsSystemWhereAVersionHasNone) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  const CrsOffset offset{.x_m = 500'000.0, .y_m = 5'400'000.0};
  const auto lost = [&](int minor) {
    const auto file = opendrive::write_open_drive(town, {"EPSG:25832", offset, minor});
    return std::ranges::count_if(file.lost, [](const auto& entry) {
      return entry.first.starts_with("place of the coordinates");
    });
  };
  EXPECT_EQ(lost(4), 1);
  EXPECT_EQ(lost(5), 0);
}

TEST(WriteOpenDrive, SignalsKeepTheirSize) {
  tests::MadeRoad road;
  road.rest = R"(<signals><signal s="50" t="-4" id="7" name="l" dynamic="yes" orientation="+"
                  zOffset="3" country="OpenDRIVE" type="1000001" subtype="-1" height="0.9"
                  width="0.3"/></signals>)";
  const RoadMap before = tests::made_map(tests::made_road(road));
  const std::string bytes = file_of(before).bytes;
  EXPECT_NE(bytes.find(R"(height="0.9" width="0.3")"), std::string::npos);
}

TEST(WriteOpenDrive, ALaneIsLeftOnlyWhereTheMapAllowsIt) {
  // Along a lane that narrows, so that its stations are not the road's.
  constexpr auto kMarks = R"(<roadMark sOffset="4" type="broken" laneChange="none"/>
                             <roadMark sOffset="45" type="none" laneChange="both"/>)";
  std::string narrowing = tests::made_lane(1, kMarks);
  narrowing.insert(narrowing.find("<roadMark"),
                   R"(<width sOffset="34" a="3.5" b="0" c="-0.0168" d="0.000448"/>
                      <width sOffset="59" a="0" b="0" c="0" d="0"/>)");
  tests::MadeRoad road;
  road.plan_view =
      R"(<geometry s="0" x="279" y="0" hdg="3.1415926" length="100"><line/></geometry>)";
  road.lanes =
      tests::made_section(0, narrowing + tests::made_lane(2), tests::made_lane(-1), kMarks);
  const RoadMap before = tests::made_map(tests::made_road(road));
  const RoadMap after = parse_map(file_of(before).bytes, "written.xodr");
  for (const Lane& lane : before.lanes()) {
    for (const auto beside : {&LaneLinks::left, &LaneLinks::right}) {
      const auto windows = [&](const RoadMap& road_map) {
        const auto& link = road_map.graph().of(lane.id).*beside;
        return link ? link->change_windows : std::vector<StationRange>{};
      };
      const auto wanted = windows(before), found = windows(after);
      ASSERT_EQ(found.size(), wanted.size()) << lane.name;
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i].from_s_m, wanted[i].from_s_m, 0.01) << lane.name;
        EXPECT_NEAR(found[i].to_s_m, wanted[i].to_s_m, 0.01) << lane.name;
      }
    }
  }
}

TEST(WriteOpenDrive, KnowsVersionsFrom4To8Only) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  EXPECT_THROW(static_cast<void>(file_of(town, 3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(file_of(town, 9)), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::map
