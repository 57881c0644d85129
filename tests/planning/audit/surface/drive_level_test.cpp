#include "roadbed/planning/audit/surface/drive_level.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "roadbed/planning/audit/surface/surface_audit.h"
#include "roadbed/tests/support/made_maps.h"

namespace roadbed::planning {
namespace {

using map::LaneId;
using testing::ElementsAre;
using testing::UnorderedElementsAre;

constexpr double kWithin_m = 9.0;

/// A bridge eastwards at 8 m, a road northwards below it, a ramp from the bridge's end down to the
/// ground, and a road at its foot.
struct Bridge {
  tests::MadeMap made;
  LaneId bridge, below, ramp, foot;

  Bridge() {
    bridge = add("1", {{0, 2}, {100, 2}}, {{0, -2}, {100, -2}}, 8, 8);
    below = add("2", {{48, -60}, {48, 60}}, {{52, -60}, {52, 60}}, 0, 0);
    ramp = add("3", {{100, 2}, {200, 2}}, {{100, -2}, {200, -2}}, 8, 0);
    foot = add("4", {{200, 2}, {300, 2}}, {{200, -2}, {300, -2}}, 0, 0);
  }

  LaneId add(const std::string& road, const std::vector<Eigen::Vector2d>& left,
             const std::vector<Eigen::Vector2d>& right, double from_z_m, double to_z_m) {
    const LaneId id = made.add_lane(made.add_road(road), "-1", left, right);
    map::Lane& lane = made.lane(id);
    for (map::LaneLine* line : {&lane.left, &lane.right, &lane.centre}) {
      line->z_m = {from_z_m, to_z_m};
    }
    return id;
  }

  std::set<LaneId> all() const { return {bridge, below, ramp, foot}; }
};

std::vector<geometry::Pose2> along(Eigen::Vector2d from, const Eigen::Vector2d& to) {
  const double steps = std::ceil((to - from).norm() / 2.0);
  const double heading_rad = std::atan2(to.y() - from.y(), to.x() - from.x());
  std::vector<geometry::Pose2> poses;
  for (double i = 0; i <= steps; i += 1.0) {
    const Eigen::Vector2d at = from + i / steps * (to - from);
    poses.push_back({at.x(), at.y(), heading_rad});
  }
  return poses;
}

TEST(DriveLevel, LeavesOutWhatIsBelowABridgeAndAboveTheRoadBelow) {
  const Bridge at;
  const map::RoadMap road_map = at.made.build();
  EXPECT_THAT(lanes_on_level(road_map, at.all(), along({5, 0}, {95, 0}), kWithin_m),
              UnorderedElementsAre(at.bridge, at.ramp, at.foot));
  EXPECT_THAT(lanes_on_level(road_map, at.all(), along({50, -55}, {50, 55}), kWithin_m),
              UnorderedElementsAre(at.below, at.ramp, at.foot));  // the ramp is nowhere near
}

TEST(DriveLevel, FollowsARampDown) {
  const Bridge at;
  const map::RoadMap road_map = at.made.build();
  EXPECT_THAT(lanes_on_level(road_map, at.all(), along({5, 0}, {295, 0}), kWithin_m),
              UnorderedElementsAre(at.bridge, at.ramp, at.foot));
  EXPECT_THAT(lanes_on_level(road_map, at.all(), along({295, 0}, {5, 0}), kWithin_m),
              UnorderedElementsAre(at.bridge, at.ramp, at.foot));
}

TEST(DriveLevel, OfADriveThatBeginsAboveAnotherIsThatOfTheLaneAlongIt) {
  const Bridge at;
  const map::RoadMap road_map = at.made.build();
  EXPECT_THAT(lanes_on_level(road_map, {at.bridge, at.below}, along({50, 0}, {60, 0}), kWithin_m),
              ElementsAre(at.bridge));
  EXPECT_THAT(lanes_on_level(road_map, {at.bridge, at.below}, along({50, 0}, {50, 9}), kWithin_m),
              ElementsAre(at.below));
}

TEST(DriveLevel, StaysWhereItWasBehindTheEdgeOfABridge) {
  const Bridge at;
  const map::RoadMap road_map = at.made.build();
  std::vector<geometry::Pose2> poses = along({20, 0}, {50, 0});
  for (const geometry::Pose2& pose : along({50, 2}, {50, 40})) poses.push_back(pose);
  EXPECT_THAT(lanes_on_level(road_map, {at.bridge, at.below}, poses, kWithin_m),
              ElementsAre(at.bridge));
}

TEST(DriveLevel, LeavesNothingOutOfAMapWithoutHeights) {
  Bridge at;
  for (const LaneId id : at.all()) {
    for (map::LaneLine* line :
         {&at.made.lane(id).left, &at.made.lane(id).right, &at.made.lane(id).centre}) {
      line->z_m = {0.0, 0.0};
    }
  }
  const map::RoadMap road_map = at.made.build();
  EXPECT_EQ(lanes_on_level(road_map, at.all(), along({5, 0}, {95, 0}), kWithin_m), at.all());
}

/// Off the bridge, onto the road below it.
TEST(DriveLevel, MakesAFallAConflict) {
  const Bridge at;
  const map::RoadMap road_map = at.made.build();
  const geometry::BodyPart body = geometry::body_of({});
  const auto verdict = [&](const std::vector<geometry::TrajectoryPoint>& rows) {
    const geometry::Trajectory drive(rows);
    const SurfaceRule rule{.road_map = &road_map};
    const RoadSurface surface =
        road_surface(surface_polygons(rule, drive, body.reach_m()), rule.seam_m);
    return audit_surface(surface, drive, std::span(&body, 1), 0.0, &road_map).verdict;
  };
  const double north_rad = 0.5 * std::numbers::pi;
  EXPECT_EQ(verdict({{.t_s = 0, .x_m = 10, .y_m = 0}, {.t_s = 5, .x_m = 90, .y_m = 0}}),
            Verdict::clear);
  EXPECT_EQ(verdict({{.t_s = 0, .x_m = 50, .y_m = -50, .heading_rad = north_rad},
                     {.t_s = 9, .x_m = 50, .y_m = 50, .heading_rad = north_rad}}),
            Verdict::clear);
  EXPECT_EQ(verdict({{.t_s = 0, .x_m = 10, .y_m = 0},
                     {.t_s = 4, .x_m = 48, .y_m = 0},
                     {.t_s = 5, .x_m = 50, .y_m = 0, .heading_rad = north_rad},
                     {.t_s = 9, .x_m = 50, .y_m = 40, .heading_rad = north_rad}}),
            Verdict::conflict);
}

}  // namespace
}  // namespace roadbed::planning
