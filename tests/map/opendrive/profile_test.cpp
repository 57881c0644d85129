// Heights and widths: superelevation, crossfall, lateral shape, lane height, widths and borders.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tests/support/made_road.h"
#include "roadbed/tests/support/open_drive_oracle.h"

namespace roadbed::map {
namespace {

using tests::lane_of;
using tests::made_lane;
using tests::made_map;
using tests::made_road;
using tests::made_section;
using tests::MadeRoad;

double height_at(const LaneLine& line, double x_m) {
  for (std::size_t i = 0; i + 1 < line.z_m.size(); ++i) {
    const double a = line.in_map.points()[i].x(), b = line.in_map.points()[i + 1].x();
    if (x_m >= std::min(a, b) && x_m <= std::max(a, b) && a != b) {
      return std::lerp(line.z_m[i], line.z_m[i + 1], (x_m - a) / (b - a));
    }
  }
  return std::nan("");
}

TEST(OpenDriveProfile, CrossfallHoldsForTheSideThatItNames) {
  MadeRoad road;
  road.lateral = R"(<crossfall side="left" s="0" a="0.02" b="0" c="0" d="0"/>
                    <crossfall side="right" s="0" a="0.05" b="0" c="0" d="0"/>)";
  const RoadMap road_map = made_map(made_road(road));
  EXPECT_NEAR(lane_of(road_map, "A/0/1").right.z_m.front(), -3.5 * std::tan(0.02), 1e-12);
  EXPECT_NEAR(lane_of(road_map, "A/0/-1").right.z_m.front(), -3.5 * std::tan(0.05), 1e-12);
}

TEST(OpenDriveProfile, CrossfallOfBothSidesFallsOutwards) {
  MadeRoad road;
  road.lateral = R"(<crossfall side="both" s="0" a="0.03" b="0" c="0" d="0"/>)";
  const RoadMap road_map = made_map(made_road(road));
  for (const char* name : {"A/0/1", "A/0/-1"}) {
    EXPECT_NEAR(lane_of(road_map, name).right.z_m.front(), -3.5 * std::tan(0.03), 1e-12) << name;
    EXPECT_NEAR(lane_of(road_map, name).left.z_m.front(), 0.0, 1e-12) << name;
  }
}

// A crown: h(t) = 0.1 − 0.02 |t| at s = 0, flat at s = 100.
MadeRoad crowned_road() {
  MadeRoad road;
  road.lateral = R"(<shape s="0" t="-10" a="-0.1" b="0.02" c="0" d="0"/>
                    <shape s="0" t="0" a="0.1" b="-0.02" c="0" d="0"/>
                    <shape s="100" t="-10" a="0" b="0" c="0" d="0"/>)";
  return road;
}

TEST(OpenDriveProfile, LateralShapeIsLinearBetweenItsStations) {
  const RoadMap road_map = made_map(made_road(crowned_road()));
  const LaneLine& outer = lane_of(road_map, "A/0/-1").right;
  EXPECT_NEAR(height_at(outer, 0.0), 0.1 - 0.02 * 3.5, 1e-9);
  EXPECT_NEAR(height_at(outer, 50.0), 0.5 * (0.1 - 0.02 * 3.5), 1e-9);
  EXPECT_NEAR(height_at(outer, 100.0), 0.0, 1e-9);
  EXPECT_NEAR(height_at(lane_of(road_map, "A/0/-1").left, 25.0), 0.075, 1e-9);
}

TEST(OpenDriveProfile, LateralShapeStandsOnTheLeaningPlane) {
  MadeRoad road = crowned_road();
  road.lateral += R"(<superelevation s="0" a="0.1" b="0" c="0" d="0"/>)";
  const RoadMap road_map = made_map(made_road(road));
  const double h_m = 0.1 - 0.02 * 3.5, t_m = -3.5;
  const LaneLine& outer = lane_of(road_map, "A/0/-1").right;
  EXPECT_NEAR(outer.in_map.points().front().y(), t_m * std::cos(0.1) - h_m * std::sin(0.1), 1e-9);
  EXPECT_NEAR(outer.z_m.front(), t_m * std::sin(0.1) + h_m * std::cos(0.1), 1e-9);
}

// Where a border of changing offset crosses a kink of the shape, its line bends there too.
TEST(OpenDriveProfile, BordersThatCrossAKinkOfTheShapeStayWithinTheError) {
  MadeRoad road;
  road.lateral = R"(<shape s="0" t="-10" a="0" b="0" c="0" d="0"/>
                    <shape s="0" t="-3" a="0" b="0.4" c="0" d="0"/>)";
  road.lanes = made_section(
      0, "",
      R"(<lane id="-1" type="driving"><width sOffset="0" a="2" b="0.02" c="0" d="0"/></lane>)");
  const RoadMap road_map = made_map(made_road(road));
  const LaneLine& outer = lane_of(road_map, "A/0/-1").right;
  for (double x_m = 0.0; x_m < 100.0; x_m += 0.37) {
    const double t_m = -(2.0 + 0.02 * x_m);
    EXPECT_NEAR(height_at(outer, x_m), t_m < -3.0 ? 0.0 : 0.4 * (t_m + 3.0), 1e-3) << x_m;
  }
}

TEST(OpenDriveProfile, ALevelLaneGoesOnFlatFromItsInnerBorder) {
  MadeRoad road;
  road.lateral = R"(<superelevation s="0" a="0.1" b="0" c="0" d="0"/>)";
  road.lanes = made_section(0, "", made_lane(-1) + R"(<lane id="-2" type="sidewalk" level="true">
                            <width sOffset="0" a="2" b="0" c="0" d="0"/></lane>)");
  const RoadMap road_map = made_map(made_road(road));
  const Lane& walk = lane_of(road_map, "A/0/-2");
  EXPECT_NEAR(walk.left.z_m.front(), -3.5 * std::sin(0.1), 1e-12);
  EXPECT_NEAR(walk.right.z_m.front(), -3.5 * std::sin(0.1), 1e-12);
  EXPECT_NEAR(walk.right.in_map.points().front().y(), -3.5 * std::cos(0.1) - 2.0, 1e-12);
}

TEST(OpenDriveProfile, LaneHeightStepsWhereItsRecordBegins) {
  MadeRoad road;
  road.lanes = made_section(
      0, "",
      made_lane(-1) +
          made_lane(-2, R"(<height sOffset="40" inner="0.12" outer="0.15"/>)", "sidewalk"));
  const RoadMap road_map = made_map(made_road(road));
  const Lane& walk = lane_of(road_map, "A/0/-2");
  EXPECT_NEAR(height_at(walk.left, 39.999), 0.0, 1e-12);
  EXPECT_NEAR(height_at(walk.left, 40.001), 0.12, 1e-12);
  EXPECT_NEAR(height_at(walk.right, 90.0), 0.15, 1e-12);
  EXPECT_NEAR(lane_of(road_map, "A/0/-1").right.z_m.back(), 0.0, 1e-12);  // the road's own edge
}

TEST(OpenDriveProfile, BordersAreMeasuredFromTheLaneOffsetAndWidthsFromTheLaneInside) {
  MadeRoad road;
  road.lanes =
      R"(<laneOffset s="0" a="0.5" b="0" c="0" d="0"/>)" +
      made_section(
          0, "",
          R"(<lane id="-1" type="driving"><border sOffset="0" a="-3" b="0" c="0" d="0"/></lane>
                               <lane id="-2" type="shoulder"><width sOffset="0" a="1" b="0" c="0" d="0"/></lane>
                               <lane id="-3" type="border"><width sOffset="0" a="1" b="0" c="0" d="0"/>
                                 <border sOffset="0" a="-9" b="0" c="0" d="0"/></lane>)");
  const RoadMap road_map = made_map(made_road(road));
  const auto outer_y = [&](const char* name) {
    return lane_of(road_map, name).right.in_map.points().front().y();
  };
  EXPECT_NEAR(outer_y("A/0/-1"), -2.5, 1e-12);
  EXPECT_NEAR(outer_y("A/0/-2"), -3.5, 1e-12);
  EXPECT_NEAR(outer_y("A/0/-3"), -4.5, 1e-12);  // of both, the width takes precedence
}

TEST(OpenDriveProfile, BothRangesOfParamPoly3AreTheSameCurve) {
  const auto with = [](const std::string& range, double scale) {
    MadeRoad road;
    road.length_m = 10.0;
    road.plan_view = fmt::format(
        R"(<geometry s="0" x="0" y="0" hdg="0" length="10"><paramPoly3 pRange="{}" aU="0" bU="{}"
            cU="0" dU="0" aV="0" bV="0" cV="{}" dV="0"/></geometry>)",
        range, 10.0 / scale, 0.5 / (scale * scale));
    return made_map(made_road(road));
  };
  const RoadMap by_length = with("arcLength", 10.0), normalized = with("normalized", 1.0);
  const auto& a = lane_of(by_length, "A/0/-1").right.in_map.points();
  const auto& b = lane_of(normalized, "A/0/-1").right.in_map.points();
  EXPECT_NEAR((a.back() - b.back()).norm(), 0.0, 1e-9);
  EXPECT_GT((a.back() - Eigen::Vector2d(10.0, -3.5)).norm(), 0.3);
}

TEST(OpenDriveProfile, AParamPoly3WhoseLengthDoesNotFitIsRemarked) {
  MadeRoad road;
  road.plan_view = R"(<geometry s="0" x="0" y="0" hdg="0" length="100"><paramPoly3
    pRange="normalized" aU="0" bU="90" cU="0" dU="0" aV="0" bV="0" cV="0" dV="0"/></geometry>)";
  EXPECT_THAT(
      tests::remarks_of(made_map(made_road(road)), "import.param-poly3-length"),
      testing::ElementsAre(testing::HasSubstr("is 90.0000 m long but its length says 100")));
}

// The same law for shapes, kinks, superelevation and all curves: an independent reading in long
// double, in three dimensions.
TEST(OpenDriveProfile, ElevationIsKeptOnEveryBorder) {
  MadeRoad road;
  road.elevation = R"(<elevation s="0" a="100" b="0.05" c="0" d="0"/>
                      <elevation s="50" a="102.5" b="0.05" c="-0.001" d="0"/>)";
  const RoadMap road_map = made_map(made_road(road));
  for (const Lane& lane : road_map.lanes()) {
    for (const LaneLine* line : {&lane.left, &lane.centre, &lane.right}) {
      EXPECT_NEAR(height_at(*line, 20.0), 101.0, 1e-3) << lane.name;
      EXPECT_NEAR(height_at(*line, 80.0), 102.5 + 1.5 - 0.9, 1e-3) << lane.name;
    }
  }
}

}  // namespace
}  // namespace roadbed::map
