// Who caused a collision by nuPlan's rule, on a road of two lanes along the x axis.
#include "roadbed/tools/simulation/collision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tools {
namespace {

/// country.xodr's road 1: its lane to the east has its middle at y = −1.75 m and is 3.5 m wide.
class Collisions : public testing::Test {
 protected:
  Collision with(double x_m, double y_m, double heading_rad, double other_mps,
                 double own_mps = 10.0, double own_y_m = -1.75) const {
    const Eigen::Vector2d own = road_map_.to_map({400.0, own_y_m}),
                          other = road_map_.to_map({400.0 + x_m, own_y_m + y_m});
    planning::VehicleState vehicle;
    vehicle.map_from_vehicle = {own.x(), own.y(), 0.0};
    vehicle.speed_mps = own_mps;
    return judge_collision(road_map_, vehicle, shape_,
                           {"other",
                            {.centre = other,
                             .axis = {std::cos(heading_rad), std::sin(heading_rad)},
                             .half_length_m = 2.0,
                             .half_width_m = 0.9},
                            other_mps});
  }

  map::RoadMap road_map_ = map::load_map(tests::data_folder() / "country.xodr");
  geometry::VehicleShape shape_;
};

TEST_F(Collisions, OfAVehicleThatStandsAreTheOthersFault) {
  const Collision hit = with(shape_.front_m() + 1.9, 0.0, std::numbers::pi, 8.0, 0.04);
  EXPECT_EQ(hit.kind, CollisionKind::stopped_vehicle);
  EXPECT_FALSE(hit.is_at_fault);
  EXPECT_EQ(hit.with, "other");
}

TEST_F(Collisions, WithWhoStandsAreTheVehiclesFaultWhereverItIsTouched) {
  const Collision hit = with(1.0, 1.7, 0.0, 0.04);
  EXPECT_EQ(hit.kind, CollisionKind::stopped_other);
  EXPECT_TRUE(hit.is_at_fault);
}

TEST_F(Collisions, AtTheFrontBumperAreTheVehiclesFault) {
  const Collision hit = with(shape_.front_m() + 1.9, 0.5, 0.0, 5.0);
  EXPECT_EQ(hit.kind, CollisionKind::front);
  EXPECT_TRUE(hit.is_at_fault);
}

TEST_F(Collisions, FromBehindAreTheOthersFault) {
  const Collision hit = with(-shape_.rear_overhang_m - 1.9, 0.5, 0.0, 15.0);
  EXPECT_EQ(hit.kind, CollisionKind::rear);
  EXPECT_FALSE(hit.is_at_fault);
  // 30° to the side of straight behind is the limit.
  const double away_m = 3.0;
  const auto kind_at = [&](double angle_rad) {
    return with(-away_m * std::cos(angle_rad), away_m * std::sin(angle_rad), 0.0, 15.0).kind;
  };
  EXPECT_EQ(kind_at(29.0 / 180.0 * std::numbers::pi), CollisionKind::rear);
  EXPECT_EQ(kind_at(31.0 / 180.0 * std::numbers::pi), CollisionKind::lateral);
}

TEST_F(Collisions, AtTheSideAreTheFaultOfWhoIsNotWhollyInOneLane) {
  const Collision in_lane = with(1.0, 1.7, 0.0, 9.0);
  EXPECT_EQ(in_lane.kind, CollisionKind::lateral);
  EXPECT_FALSE(in_lane.is_at_fault);
  const double half_m = 0.5 * shape_.width_m;
  EXPECT_FALSE(with(1.0, 1.7, 0.0, 9.0, 10.0, -half_m - 0.02).is_at_fault);
  EXPECT_TRUE(with(1.0, 1.7, 0.0, 9.0, 10.0, -half_m + 0.02).is_at_fault) << "over the middle";
  EXPECT_TRUE(with(1.0, 1.7, 0.0, 9.0, 10.0, -3.5 + half_m - 0.02).is_at_fault) << "on the verge";
}

}  // namespace
}  // namespace roadbed::tools
