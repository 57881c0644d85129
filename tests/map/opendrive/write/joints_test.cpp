#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "roadbed/tests/map/opendrive/write/written_map.h"
#include "roadbed/tests/support/made_lanelet2.h"

// Where roads end and meet.
namespace roadbed::map {
namespace {

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

TEST(WrittenJoints, LanesWhoseBordersEndAtDifferentPlacesComeBack) {
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

TEST(WrittenJoints, BordersEndWhereTheMapsEndThoughTheyAreOutOfLine) {
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

TEST(WrittenJoints, LanesMeetWhereTheMapLeavesAGap) {
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
    EXPECT_EQ(file.notes.size(), file.largest_error_m > 0.01 ? 1u : 0u);
    for (const std::string& note : file.notes) {
      EXPECT_NE(note.find(" m off, at 30.00,4."), note.npos) << gap_m << ": " << note;
    }
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

TEST(WrittenJoints, LanesThatFaceEachOtherKeepTheirCorners) {
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

TEST(WrittenJoints, LanesThatLeadNowhereEndBesideOneThatLeadsOn) {
  for (const double short_m : {0.02, 0.4, 1.5}) {
    SCOPED_TRACE(short_m);
    GateLanes lanes;
    const auto [left, right] = lanes.gate({40, 3.5}, {40, 0});
    const auto [begin, first] = lanes.gate({0, 3.5}, {0, 0});
    const auto [second, third] = lanes.gate({0, -2}, {0, -4});
    const auto [second_end, third_end] = lanes.gate({40 - 2 * short_m, -2}, {40 - short_m, -4});
    const std::int64_t between = lanes.way(first, {{20, 0}}, right);
    const std::int64_t between_ended = lanes.way(second, {{20, -2}}, second_end);
    lanes.lanelet(lanes.way(begin, {{20, 3.5}}, left), between);
    lanes.lanelet(between, between_ended);
    lanes.lanelet(between_ended, lanes.way(third, {{20, -4}}, third_end));
    lanes.lane({left, right}, {{60, 3.6}}, {{60, 0.1}}, lanes.gate({80, 4}, {80, 0.5}));
    const RoadMap before = lanes.road_map();
    ASSERT_EQ(before.lanes().size(), 4u);
    expect_comes_back(before, 8, 0.97);
    EXPECT_EQ(errors_in(file_of(before)), std::vector<std::string>{});
  }
}

TEST(WrittenJoints, ALaneMayTurnAboutItsInnerCorner) {
  // From the end of the outer border the inner one is 8 m away, which is 2.4 m long.
  GateLanes lanes;
  const GateLanes::Gate from = lanes.gate({-1, 7.9}, {0, 0}),
                        to = lanes.gate({5.4, 2.9}, {2.1, -1.1});
  lanes.lane(lanes.gate({-20, 6}, {-20, -2}), {}, {}, from);
  lanes.lane(from, {{3, 6.7}, {4.4, 5.5}}, {}, to);
  lanes.lane(to, {}, {}, lanes.gate({14, -8}, {10.5, -11}));
  expect_comes_back(lanes.road_map(), 8);
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

TEST(WrittenJoints, ALaneThatTurnsBackStaysInOnePiece) {
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

TEST(WrittenJoints, NoLaneOfACopyBeginsNowhere) {
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

}  // namespace
}  // namespace roadbed::map
