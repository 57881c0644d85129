#include "roadbed/planning/tracking/perceived_traffic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

class PerceivedTraffics : public testing::Test {
 protected:
  /// Where a car may be after 4 s that has been measured along its lane for 2 s, as a vehicle
  /// plans for it that drives towards `heading_rad`.
  std::vector<Eigen::Vector2d> planned_for(const std::string& name, double s_m, double speed_mps,
                                           double heading_rad, double turned_rad = 0.0) {
    PerceivedTraffic perceived(
        road_map_, {.noise = {.position_m = 0.01, .heading_rad = 0.001, .speed_mps = 0.01}});
    const map::Lane& on = road_map_.lane(this->lane(name));
    for (int k = -20; k <= 0; ++k) {
      const geometry::Pose2 then =
          on.pose_at(s_m + 0.1 * k * speed_mps) * geometry::Pose2{0.0, 0.0, turned_rad};
      perceived.observe(0.1 * k,
                        std::vector{Detection{.id = "a", .centre = then, .speed_mps = speed_mps}});
    }
    std::vector<Eigen::Vector2d> places;
    for (const Obstacle& obstacle : perceived.obstacles({0.0, 0.0, heading_rad})) {
      if (obstacle.id == "a") places.push_back(obstacle.motion.at(4.0).pose().position());
    }
    return places;
  }

  map::LaneId lane(const std::string& name) const { return *road_map_.find_lane(name); }

  map::RoadMap road_map_ = map::load_map(tests::data_folder() / "town.xodr");
};

bool has_one_near(const std::vector<Eigen::Vector2d>& places, const Eigen::Vector2d& place) {
  return std::ranges::any_of(
      places, [&](const Eigen::Vector2d& one) { return (one - place).norm() < 4.0; });
}

/// A vehicle that waits at the entry from the north, for a car in the ring: it may leave to the
/// north, past the vehicle, or go on to the west, across its way.
TEST_F(PerceivedTraffics, WhoDrivesInARoundaboutMayStayInIt) {
  const auto places = planned_for("20/0/-1", 2.0, 8.3, -0.5 * std::numbers::pi);
  EXPECT_TRUE(has_one_near(places, road_map_.lane(lane("2102/0/-1")).pose_at(25.8).position()));
  EXPECT_TRUE(has_one_near(places, road_map_.lane(lane("2100/0/-1")).pose_at(25.8).position()));
}

/// Who goes straight on at a crossing, but a little to the left, may turn: that is planned for by a
/// vehicle that comes from the right; one that comes towards them has the right of way.
TEST_F(PerceivedTraffics, WhoTurnsAcrossOncomingTrafficGivesWayToIt) {
  for (const std::string straight : {"1004/0/-1", "1010/0/-1"}) {
    const double heading_rad = road_map_.lane(lane(straight)).pose_at(0.0).heading_rad;
    const auto planned = [&](double from_rad) {
      return planned_for(straight, 7.0, 6.0, heading_rad + from_rad, 0.03).size();
    };
    EXPECT_EQ(planned(0.5 * std::numbers::pi), 2U) << straight;
    EXPECT_EQ(planned(std::numbers::pi), 1U) << straight;
  }
}

}  // namespace
}  // namespace roadbed::planning
