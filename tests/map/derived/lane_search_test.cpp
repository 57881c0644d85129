#include "roadbed/map/derived/lane_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "roadbed/tests/support/bent_lanes.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

TEST(LanesInBox, AreThoseWithAPointInIt) {
  std::mt19937 random(20261121);
  const RoadMap road_map = tests::random_arc_lanes(random, 60, 60.0).build();
  std::uniform_real_distribution<double> place(-70.0, 70.0), size(0.2, 12.0);
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    const Vector2d low(place(random), place(random));
    const geometry::Box box(low, low + Vector2d(size(random), size(random)));
    const auto lanes = lanes_in_box(road_map, box);
    for (const Lane& lane : road_map.lanes()) {
      bool sampled = false;  // dense sampling finds all but the slightest overlaps
      for (int x = 0; x <= 40 && !sampled; ++x) {
        for (int y = 0; y <= 40 && !sampled; ++y) {
          const Vector2d fraction(x / 40.0, y / 40.0);
          sampled =
              geometry::contains(lane.polygon, box.min() + fraction.cwiseProduct(box.sizes()));
        }
      }
      const bool listed = std::find(lanes.begin(), lanes.end(), lane.id) != lanes.end();
      EXPECT_TRUE(listed || !sampled) << lane.name;
      if (!listed) continue;
      ++found;
      double least_m = 1e300;  // from the lane's outline to the box: 0 if they meet
      for (const Vector2d& corner : lane.polygon) {
        least_m = std::min(least_m, box.exteriorDistance(corner));
      }
      EXPECT_LT(least_m, 0.5 * 4.5 + 0.5) << lane.name;
    }
  }
  EXPECT_GT(found, 50);
}

TEST(LanesInBox, ASmallBoxWithinALaneFindsIt) {
  const RoadMap road_map = tests::straight_two_lane_road(100.0).build();
  const geometry::Box inside(Vector2d(50.0, -2.0), Vector2d(50.1, -1.9));
  EXPECT_EQ(lanes_in_box(road_map, inside), std::vector<LaneId>{LaneId{0}});
  const geometry::Box beside(Vector2d(50.0, -5.0), Vector2d(60.0, -3.6));
  EXPECT_TRUE(lanes_in_box(road_map, beside).empty());
}

TEST(LanesAlongRay, GivesDistancesAtWhichTheRayEntersAndLeaves) {
  const RoadMap road_map = tests::straight_two_lane_road(100.0).build();
  const auto passed = lanes_along_ray(road_map, {30.0, -10.0}, 1.5707963267948966, 20.0);
  ASSERT_EQ(passed.size(), 2u);
  EXPECT_EQ(passed[0].lane, LaneId{0});
  EXPECT_NEAR(passed[0].from_m, 6.5, 1e-9);
  EXPECT_NEAR(passed[0].to_m, 10.0, 1e-9);
  EXPECT_EQ(passed[1].lane, LaneId{1});
  EXPECT_NEAR(passed[1].to_m, 13.5, 1e-9);
}

TEST(LanesAlongRay, AgreesWithSamplingTheRay) {
  std::mt19937 random(20261123);
  const RoadMap road_map = tests::random_arc_lanes(random, 60, 60.0).build();
  std::uniform_real_distribution<double> place(-70.0, 70.0), heading(-3.0, 3.0);
  for (int i = 0; i < 50; ++i) {
    const Vector2d from(place(random), place(random));
    const double heading_rad = heading(random), length_m = 250.0;
    std::vector<double> expected_m(road_map.lanes().size()), found_m(expected_m);
    constexpr double kStep_m = 0.01;
    for (double at = 0.5 * kStep_m; at < length_m; at += kStep_m) {
      const Vector2d point = from + at * Vector2d(std::cos(heading_rad), std::sin(heading_rad));
      for (const LaneMatch& match : road_map.locate(point, 0.0, false)) {
        expected_m[match.place.lane.index] += kStep_m;
      }
    }
    for (const LaneOnRay& on : lanes_along_ray(road_map, from, heading_rad, length_m)) {
      EXPECT_LT(on.from_m, on.to_m);
      found_m[on.lane.index] += on.to_m - on.from_m;
    }
    for (std::size_t k = 0; k < found_m.size(); ++k) {
      EXPECT_NEAR(found_m[k], expected_m[k], 4 * kStep_m) << "lane " << k;
    }
  }
}

}  // namespace
}  // namespace roadbed::map
