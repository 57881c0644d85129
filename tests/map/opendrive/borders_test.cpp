// Borders of made roads, with heights, against the independent evaluation; and how many vertices
// they take, against a greedy choice of the fewest.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_open_drive.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tests/support/open_drive_oracle.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> points_of(const LaneLine& line) {
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < line.z_m.size(); ++i) {
    const Eigen::Vector2d& point = line.in_map.points()[i];
    points.emplace_back(point.x(), point.y(), line.z_m[i]);
  }
  return points;
}

double distance_m(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double fraction =
      length2 > 0.0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (point - a - fraction * along).norm();
}

double distance_m(const Vector3d& point, const std::vector<Vector3d>& line) {
  double least_m = 1e300;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    least_m = std::min(least_m, distance_m(point, line[i], line[i + 1]));
  }
  return least_m;
}

// Worst distance in space of points of the true borders from the lanes' lines.
double worst_border_m(const std::string& document) {
  const RoadMap road_map = parse_map(document, "made.xodr");
  const auto oracle = tests::OpenDriveOracle::of_text(document);
  double worst_m = 0.0;
  for (const Lane& lane : road_map.lanes()) {
    const auto [low_s, high_s] = std::minmax(lane.origin.road_from_s_m, lane.origin.road_to_s_m);
    const bool forward = lane.origin.road_from_s_m < lane.origin.road_to_s_m;
    const int id = std::stoi(lane.origin.source_id);
    const auto left = points_of(lane.left), right = points_of(lane.right);
    const bool left_is_outer = (id > 0) == forward;
    for (int i = 0; i <= 400; ++i) {
      const double s_m = low_s + (high_s - low_s) * i / 400;
      const double inside_m = std::clamp(s_m, low_s + 1e-7, high_s - 1e-7);
      const auto [inner, outer] = oracle.borders_with_height(
          road_map.road(*lane.road).source_id, lane.origin.section, id, s_m, inside_m);
      worst_m = std::max({worst_m, distance_m(inner.cast<double>(), left_is_outer ? right : left),
                          distance_m(outer.cast<double>(), left_is_outer ? left : right)});
    }
  }
  return worst_m;
}

TEST(OpenDriveBorders, OfAllCurvesAreWithinAMillimetreInSpace) {
  EXPECT_LT(worst_border_m(tests::curved_road_xml()), 1e-3);
}

TEST(OpenDriveBorders, OnShapedLeaningRoadsAreWithinAMillimetreInSpace) {
  tests::MadeRoad road;
  road.plan_view =
      R"(<geometry s="0" x="0" y="0" hdg="0.2" length="60"><spiral curvStart="0.02" curvEnd="-0.05"/></geometry>
         <geometry s="60" x="55" y="12" hdg="-0.7" length="40"><poly3 a="0" b="0.1" c="0.01" d="-0.0002"/></geometry>)";
  road.elevation = R"(<elevation s="0" a="3" b="0.02" c="0.001" d="-0.00001"/>)";
  road.lateral = R"(<superelevation s="0" a="0.02" b="0.002" c="-0.00003" d="0"/>
    <crossfall side="left" s="0" a="0.01" b="0.0005" c="0" d="0"/>
    <crossfall side="both" s="50" a="0.03" b="0" c="0" d="0"/>
    <shape s="0" t="-9" a="0.3" b="-0.04" c="0" d="0"/><shape s="0" t="-4" a="0.1" b="-0.02" c="0.003" d="0"/>
    <shape s="0" t="1" a="0.075" b="0.03" c="0" d="0.001"/>
    <shape s="70" t="-9" a="0" b="0.05" c="0" d="0"/><shape s="70" t="2" a="0.55" b="-0.1" c="0" d="0"/>)";
  road.lanes =
      R"(<laneOffset s="0" a="0.3" b="0.01" c="0" d="0"/>)" +
      tests::made_section(
          0,
          R"(<lane id="1" type="driving"><width sOffset="0" a="2" b="0.05" c="0" d="0"/></lane>)",
          R"(<lane id="-1" type="driving"><width sOffset="0" a="3" b="0.03" c="-0.0002" d="0"/></lane>
                      <lane id="-2" type="shoulder"><width sOffset="0" a="1" b="0" c="0.0004" d="0"/></lane>
                      <lane id="-3" type="sidewalk" level="true"><width sOffset="0" a="2" b="0" c="0" d="0"/></lane>)");
  EXPECT_LT(worst_border_m(tests::made_document(tests::made_road(road))), 1e-3);
}

std::string two_lanes_each_way() {
  return tests::made_section(
      0,
      R"(<lane id="1" type="driving"><width sOffset="0" a="3" b="0.02" c="0" d="0"/></lane>
         <lane id="2" type="driving"><width sOffset="0" a="2.5" b="0" c="0.0003" d="0"/></lane>)",
      R"(<lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>
         <lane id="-2" type="shoulder"><width sOffset="0" a="2" b="0.01" c="0" d="0"/></lane>
         <lane id="-3" type="sidewalk" level="true"><width sOffset="0" a="2" b="0" c="0" d="0"/></lane>)");
}

// Strips that move aside, widen, bend, and stand on each other or not; lanes cross their edges.
std::string surface_strips_xml(const char* mode, double constant_m) {
  tests::MadeRoad road;
  road.plan_view =
      R"(<geometry s="0" x="0" y="0" hdg="0.2" length="100"><arc curvature="0.01"/></geometry>)";
  road.elevation = R"(<elevation s="0" a="3" b="0.02" c="0.0001" d="0"/>)";
  road.lateral = fmt::format(
      R"(<crossSectionSurface>
        <tOffset><coefficients s="0" a="0.5" b="-0.02" c="0.0001"/></tOffset>
        <surfaceStrips>
         <strip id="1"><width><coefficients s="0" a="2.5" b="0.015"/></width>
          <linear><coefficients s="0" a="-0.03" b="0.001"/><coefficients s="40" a="0.01" c="-0.00002"/></linear>
          <quadratic><coefficients s="0" a="0.004" d="0.0000001"/></quadratic></strip>
         <strip id="2" mode="{0}"><constant><coefficients s="0" a="{1}"/></constant>
          <linear><coefficients s="0" a="-0.05"/></linear>
          <cubic><coefficients s="0" a="0.001" b="0.00001"/></cubic></strip>
         <strip id="-1"><width><coefficients s="0" a="4"/></width>
          <linear><coefficients s="0" a="0.02"/><coefficients s="60" a="0.02" b="0.0005"/></linear></strip>
         <strip id="-2" mode="{0}"><linear><coefficients s="0" a="0.06"/></linear></strip>
        </surfaceStrips></crossSectionSurface>)",
      mode, constant_m);
  road.lanes = two_lanes_each_way();
  return tests::made_document(tests::made_road(road));
}

TEST(OpenDriveBorders, OnStripsThatStandOnEachOtherAreWithinAMillimetreInSpace) {
  EXPECT_LT(worst_border_m(surface_strips_xml("relative", 0.0)), 1e-3);
}

TEST(OpenDriveBorders, OnAOneStripSurfaceLieAtTheHeightOfTheFormula) {
  tests::MadeRoad road;
  road.lateral = R"(<crossSectionSurface><surfaceStrips>
      <strip id="1"><linear><coefficients s="0" a="-0.1"/></linear></strip>
      <strip id="-1"><linear><coefficients s="0" a="0.15"/></linear></strip>
    </surfaceStrips></crossSectionSurface>)";
  road.lanes = tests::made_section(
      0, R"(<lane id="1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>)",
      R"(<lane id="-1" type="driving"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane>)");
  const RoadMap road_map = parse_map(tests::made_document(tests::made_road(road)), "strips.xodr");
  for (const Lane& lane : road_map.lanes()) {
    const double outer_m = lane.origin.source_id == "1" ? -0.35 : -0.45;
    for (const double z_m : lane.right.z_m) EXPECT_NEAR(z_m, outer_m, 1e-12) << lane.name;
    for (const double z_m : lane.left.z_m) EXPECT_NEAR(z_m, 0.0, 1e-12) << lane.name;
  }
}

TEST(OpenDriveBorders, OnIndependentStripsStepWhereTheStripsDo) {
  tests::MadeRoad road;
  road.lateral = R"(<crossSectionSurface><surfaceStrips>
      <strip id="-1"><width><coefficients s="0" a="3"/></width>
       <linear><coefficients s="0" a="0.1"/></linear></strip>
      <strip id="-2" mode="independent"><constant><coefficients s="0" a="0.5"/></constant>
       <linear><coefficients s="0" a="0.2"/></linear></strip>
    </surfaceStrips></crossSectionSurface>)";
  road.lanes = tests::made_section(
      0, "", R"(<lane id="-1" type="driving"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane>
                <lane id="-2" type="driving"><width sOffset="0" a="2" b="0" c="0" d="0"/></lane>)");
  const std::string document = tests::made_document(tests::made_road(road));
  const RoadMap road_map = parse_map(document, "strips.xodr");
  EXPECT_NEAR(tests::lane_of(road_map, "A/0/-1").right.z_m.front(), -0.3, 1e-12);
  EXPECT_NEAR(tests::lane_of(road_map, "A/0/-2").right.z_m.front(), 0.5 - 0.4, 1e-12);
  EXPECT_LT(worst_border_m(document), 1e-3);
}

TEST(OpenDriveBorders, BeforeTheFirstRecordOfAProfileTheProfileIsZero) {
  tests::MadeRoad road;
  road.elevation = R"(<elevation s="30" a="2" b="0.02" c="0" d="0"/>)";
  road.lateral = R"(<superelevation s="40" a="0.03" b="0.001" c="0" d="0"/>
                    <crossfall side="left" s="20" a="0.02" b="0" c="0" d="0"/>)";
  // The standard's own example of a lane offset (11.4) begins at 25 m.
  road.lanes =
      R"(<laneOffset s="25" a="0" b="0" c="0.0039" d="-0.000052"/>)" + two_lanes_each_way();
  const std::string document = tests::made_document(tests::made_road(road));
  EXPECT_LT(worst_border_m(document), 1e-3);
  const RoadMap road_map = parse_map(document, "late.xodr");
  const Lane& lane = tests::lane_of(road_map, "A/0/-1");
  EXPECT_NEAR(lane.left.in_map.points().front().y(), 0.0, 1e-12);
  EXPECT_EQ(tests::remarks_of(road_map, "import.late-profile").size(), 3u);
}

TEST(OpenDriveBorders, AStepBackOfRoundingIsNone) {
  tests::MadeRoad road;
  road.elevation = R"(<elevation s="0" a="0" b="0" c="0" d="0"/>
    <elevation s="50.00000000001644" a="0" b="0.05" c="0" d="0"/>
    <elevation s="49.99999999992425" a="0" b="0.02" c="0" d="0"/>)";
  road.lanes = R"(<laneOffset s="0" a="-3.7" b="0" c="0" d="0"/>
    <laneOffset s="37.70000000001644" a="-3.7" b="0" c="0.0038476" d="-0.00004775"/>
    <laneOffset s="37.69999999992425" a="-3.7" b="0.05" c="0.0005" d="0"/>)" +
               two_lanes_each_way();
  EXPECT_LT(worst_border_m(tests::made_document(tests::made_road(road))), 1e-3);
}

// As netconvert writes gentle curves: s runs along them at 0.75 to 1.1 of the speed it should, so
// that |position″| is twenty times what lies across the curve.
std::string uneven_road_xml() {
  tests::MadeRoad road;
  road.length_m = 40;
  road.plan_view.clear();
  double x_m = 0.0, y_m = 0.0, heading_rad = 0.0;
  for (int i = 0; i < 20; ++i) {
    constexpr double kU = 2.0, kV = -0.0272653;
    road.plan_view += fmt::format(
        R"(<geometry s="{}" x="{}" y="{}" hdg="{}" length="2"><paramPoly3 aU="0" bU="1.5" cU="1.5" )"
        R"(dU="-1" aV="0" bV="0" cV="-0.0344296" dV="0.0071643" pRange="normalized"/></geometry>)",
        2 * i, x_m, y_m, heading_rad);
    x_m += kU * std::cos(heading_rad) - kV * std::sin(heading_rad);
    y_m += kU * std::sin(heading_rad) + kV * std::cos(heading_rad);
    heading_rad += std::atan2(-2 * 0.0344296 + 3 * 0.0071643, 1.5);
  }
  road.elevation = R"(<elevation s="0" a="3" b="0.04" c="0.0005" d="0"/>)";
  road.lateral = R"(<crossfall side="both" s="0" a="0.03" b="0" c="0" d="0"/>)";
  road.lanes = tests::made_section(
      0, R"(<lane id="1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>)",
      R"(<lane id="-1" type="driving"><width sOffset="0" a="3" b="0.02" c="0" d="0"/></lane>)");
  return tests::made_document(tests::made_road(road));
}

TEST(OpenDriveBorders, OfUnevenlyParametrisedCurvesAreWithinAMillimetreInSpace) {
  EXPECT_LT(worst_border_m(uneven_road_xml()), 1e-3);
}

// The fewest rows of vertices that keep both borders of a lane within the error, each row as far
// from the last one as it can be. Dense lines stand for the curves.
std::size_t fewest_rows(const Lane& dense, double max_error_m) {
  const auto left = points_of(dense.left), right = points_of(dense.right);
  const auto fits = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from + 1; i < to; ++i) {
      if (distance_m(left[i], left[from], left[to]) > max_error_m ||
          distance_m(right[i], right[from], right[to]) > max_error_m) {
        return false;
      }
    }
    return true;
  };
  std::size_t rows = 1;
  for (std::size_t at = 0; at + 1 < left.size(); ++rows) {
    std::size_t next = at + 1;
    while (next + 1 < left.size() && fits(at, next + 1)) ++next;
    at = next;
  }
  return rows;
}

// Ours over the fewest, all lanes together.
double row_share(const std::string& bytes) {
  constexpr double error_m = 1e-3;
  const RoadMap usual = parse_map(bytes, "made.xodr", {.max_error_m = error_m});
  const RoadMap dense = parse_map(bytes, "made.xodr", {.max_error_m = 1e-5});
  std::size_t ours = 0, fewest = 0;
  for (const Lane& lane : usual.lanes()) {
    ours += lane.left.z_m.size();
    fewest += fewest_rows(dense.lane(lane.id), error_m);
  }
  fmt::print("{} rows of vertices, {} at least: {:.2f}\n", ours, fewest,
             static_cast<double>(ours) / static_cast<double>(fewest));
  return static_cast<double>(ours) / static_cast<double>(fewest);
}

TEST(OpenDriveBorders, TakeFewMoreVerticesThanTheyMust) {
  EXPECT_LT(row_share(tests::curved_road_xml()), 1.5);
}

TEST(OpenDriveBorders, OfUnevenlyParametrisedCurvesTakeNoVerticesForTheUnevenness) {
  EXPECT_LT(row_share(uneven_road_xml()), 3.0);
}

}  // namespace
}  // namespace roadbed::map
