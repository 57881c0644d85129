#include "roadbed/planning/obstacles/other_levels.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

using geometry::Pose2;

constexpr double kNorth_rad = 0.5 * std::numbers::pi;

std::string road(int id, double x_m, double y_m, double heading_rad, double height_m) {
  return fmt::format(
      R"(<road id="{}" length="400" junction="-1"><planView><geometry s="0" x="{}" y="{}" hdg="{}"
length="400"><line/></geometry></planView><elevationProfile><elevation s="0" a="{}" b="0" c="0"
d="0"/></elevationProfile><lanes><laneSection s="0"><center><lane id="0" type="none"/></center>
<right><lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></right>
</laneSection></lanes></road>)",
      id, x_m, y_m, heading_rad, height_m);
}

class OtherLevelsOfABridge : public testing::Test {
 protected:
  /// A road to the east, and over it one to the north.
  static map::RoadMap crossing(double bridge_m) {
    const tests::TemporaryFolder folder;
    return map::load_map(folder.write(
        "bridge.xodr", R"(<?xml version="1.0"?><OpenDRIVE><header revMajor="1" revMinor="6"/>)" +
                           road(1, -200.0, 0.0, 0.0, 0.0) +
                           road(2, 0.0, -200.0, kNorth_rad, bridge_m) + "</OpenDRIVE>"));
  }

  static OtherLevels levels(const map::RoadMap& road_map) {
    const map::LaneId lane = *road_map.find_lane("1/0/-1");
    return {road_map, *find_route(road_map, {{lane, 10.0, 0.0}}, {{lane, 390.0, 0.0}}).route};
  }

  /// Passes the crossing at 30 s.
  static Obstacle heading(double heading_rad, const std::string& kind = "car") {
    const Pose2 towards{0.0, -1.75, heading_rad};
    std::vector<geometry::TrajectoryPoint> points;
    for (double t_s = 0.0; t_s <= 60.0; t_s += 0.5) {
      const Pose2 at = towards * Pose2{6.0 * (t_s - 30.0), 0.0, 0.0};
      points.push_back({t_s, at.x_m, at.y_m, at.heading_rad, 6.0});
    }
    return {.id = "other", .kind = kind, .motion = geometry::Trajectory(std::move(points))};
  }

  static bool is_there(const OtherLevels& levels, const Obstacle& obstacle, double t_s) {
    std::vector<Obstacle> all{obstacle};
    levels.leave_out({-60.0, -1.75, 0.0}, t_s, all);
    return all.front().is_there(t_s);
  }
};

TEST_F(OtherLevelsOfABridge, WhoDrivesOverIsNotThereWhileItIsNearTheRoute) {
  const map::RoadMap road_map = crossing(6.0);
  const OtherLevels other_levels = levels(road_map);
  EXPECT_TRUE(is_there(other_levels, heading(kNorth_rad), 20.0));
  for (const double t_s : {28.5, 30.0, 31.5}) {
    EXPECT_FALSE(is_there(other_levels, heading(kNorth_rad), t_s)) << t_s;
  }
  EXPECT_TRUE(is_there(other_levels, heading(kNorth_rad), 40.0));
}

TEST_F(OtherLevelsOfABridge, WhoDrivesAlongTheRouteIsThere) {
  const map::RoadMap road_map = crossing(6.0);
  EXPECT_TRUE(is_there(levels(road_map), heading(0.0), 30.0));
  EXPECT_TRUE(is_there(levels(road_map), heading(-kNorth_rad), 30.0));  // against the bridge's lane
}

TEST_F(OtherLevelsOfABridge, WhoWalksAcrossIsThere) {
  const map::RoadMap road_map = crossing(6.0);
  EXPECT_TRUE(is_there(levels(road_map), heading(kNorth_rad, "pedestrian"), 30.0));
}

TEST_F(OtherLevelsOfABridge, WhoCrossesOnTheLevelIsThere) {
  const map::RoadMap road_map = crossing(2.0);
  EXPECT_TRUE(is_there(levels(road_map), heading(kNorth_rad), 30.0));
}

TEST(OtherLevels, ARouteOverAHighwayAndLaterAlongItMeetsNobodyTwice) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const map::RoadMap road_map =
      map::load_map(folder / "opendrive/BerkeleyLearnVerify+Scenic/Town04.xodr");
  const map::LaneId street = *road_map.find_lane("39/0/-4");
  const map::LaneId highway = *road_map.find_lane("47/0/-4");
  const OtherLevels levels(
      road_map, *find_route(road_map, {{street, 1.0, 0.0}}, {{highway, 100.0, 0.0}}).route);
  const Pose2 crossing{15.5, -6.3, kNorth_rad};  // 11 m under the street
  std::vector<Obstacle> all{{.id = "on the highway",
                             .motion = geometry::Trajectory(
                                 {{0.0, crossing.x_m, crossing.y_m, crossing.heading_rad, 0.0}})}};
  levels.leave_out({50.0, -6.3, std::numbers::pi}, 0.0, all);
  EXPECT_FALSE(all.front().is_there(0.0));
  levels.leave_out({15.5, -30.0, kNorth_rad}, 0.0, all);
  EXPECT_TRUE(all.front().is_there(0.0));
}

}  // namespace
}  // namespace roadbed::planning
