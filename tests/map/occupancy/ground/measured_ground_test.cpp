#include "roadbed/map/occupancy/ground/drive_ground.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/vehicle_audit.h"

namespace roadbed::planning {
namespace {

using map::OccupancyMap;
using testing::HasSubstr;

constexpr double kCell_m = 0.1;

/// A block that stands on the road: from x to x + length, and from right to left.
struct Slab {
  double from_m = 10.0, length_m = 2.0, right_m = -1.2, left_m = 1.2, height_m = 0.3;
  bool has_sides = true;  ///< seen, not only its top
};

struct Road {
  double level_m = 0.05, slope = 0.0;
  double at(double x) const { return level_m + slope * x; }
};

/// What a scanner above would see of 34 m of road, 8 m wide: no ground under the slab. Posts stand
/// beside it, so that what lies above the road was looked at.
OccupancyMap road_with(const Road& road, const std::optional<Slab>& slab) {
  map::PointCloud cloud;
  const auto add = [&](double x, double y, double z) {
    cloud.points.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  };
  constexpr double step_m = 0.09;
  for (double x = -6.0; x < 28.0; x += step_m) {
    for (double y = -4.0; y < 4.0; y += step_m) {
      const double in_m = slab ? std::min({x - slab->from_m, slab->from_m + slab->length_m - x,
                                           y - slab->right_m, slab->left_m - y})
                               : -1.0;
      const double top_m = road.at(x) + (in_m >= 0.0 ? slab->height_m : 0.0);
      add(x, y, top_m);
      if (in_m < 0.0 || in_m > step_m || !slab->has_sides) continue;
      for (double z = road.at(x); z < top_m; z += step_m) add(x, y, z);
    }
  }
  for (double x = -6.0; x < 28.0; x += 4.0) add(x, 6.0, road.at(x) + 0.9);
  return OccupancyMap::build(std::vector{cloud}, {.resolution_m = kCell_m});
}

geometry::Trajectory ahead(double from_m, double to_m) {
  return geometry::Trajectory({{.t_s = 0, .x_m = from_m}, {.t_s = 10, .x_m = to_m}});
}

/// What an audit over the measured ground says; nothing if the ground is refused.
std::optional<Verdict> verdict(const OccupancyMap& occupancy, const geometry::Trajectory& drive,
                               double from_height_m) {
  const std::vector<geometry::BodyPart> car{geometry::body_of({}, from_height_m)};
  GroundUnder under{.margin_m = map::measured_ground_margin_m(kCell_m)};
  try {
    under.surface = std::make_shared<const map::Ground>(
        map::measured_under(occupancy, drive, {car.front().rear_m, car.front().front_m}));
  } catch (const map::InputError&) {
    return std::nullopt;
  }
  const AuditOptions options{.unknown = UnknownPolicy::free};
  const VehicleSurroundings around(occupancy, under, car, audited_region(drive, car, options));
  return audit_vehicle(around, drive, options).whole.verdict;
}

TEST(MeasuredGround, LetsAFreeRoadBeFreeOnTheLevelAndOnASlope) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> level_m(0.0, 0.1);
  for (const double slope : {0.0, 0.02, 0.05, 0.08}) {
    for (int i = 0; i < 4; ++i) {
      const OccupancyMap road = road_with({level_m(random), slope}, std::nullopt);
      EXPECT_EQ(verdict(road, ahead(-2.0, 20.0), 0.3), Verdict::clear) << slope;
    }
  }
}

TEST(MeasuredGround, IsTheRoadToACellUnderAllOfTheBody) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> level_m(0.0, 0.1);
  for (const double slope : {0.0, 0.03, 0.08}) {
    const Road road{level_m(random), slope};
    const map::Ground ground =
        map::measured_under(road_with(road, std::nullopt), ahead(0.0, 20.0), {-1.0, 4.0});
    for (double x = -1.0; x < 24.0; x += 0.3) {
      for (const double y : {-1.5, 0.0, 1.5}) {
        EXPECT_NEAR(ground.height_m({x, y}), road.at(x), map::measured_ground_margin_m(kCell_m));
      }
    }
  }
}

class SlabOnTheRoad : public testing::TestWithParam<double> {};

TEST_P(SlabOnTheRoad, IsNeverTakenForGround) {
  const double slope = GetParam();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> level_m(0.0, 0.1), from_m(8.0, 9.0);
  for (const double height_m : {0.21, 0.24, 0.3, 0.35, 0.45, 0.5}) {
    for (const double length_m : {1.0, 2.4, 4.0, 8.0}) {
      for (const double half_m : {4.0, 2.0, 1.2, 0.6}) {
        const Slab slab{.from_m = from_m(random),
                        .length_m = length_m,
                        .right_m = -half_m,
                        .left_m = half_m,
                        .height_m = height_m,
                        .has_sides = random() % 2 == 0};
        const OccupancyMap road = road_with({level_m(random), slope}, slab);
        const double underside_m = height_m > 0.26 ? 0.25 : 0.2;
        for (const auto& drive : {ahead(-2.0, 20.0), ahead(9.5, 20.0), ahead(20.0, -2.0)}) {
          EXPECT_NE(verdict(road, drive, underside_m), Verdict::clear)
              << height_m << " m high, " << length_m << " m long, " << half_m << " m to a side";
        }
      }
    }
  }
}

TEST_P(SlabOnTheRoad, BesideTheMiddleIsNeverTakenForGround) {
  const double slope = GetParam();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> level_m(0.0, 0.1), from_m(8.0, 9.0);
  for (const double height_m : {0.24, 0.32, 0.5}) {
    for (const double length_m : {1.0, 3.0, 8.0}) {
      for (const double right_m : {-0.5, 0.0, 0.5}) {
        const Slab slab{.from_m = from_m(random),
                        .length_m = length_m,
                        .right_m = right_m,
                        .left_m = 4.0,
                        .height_m = height_m};
        const OccupancyMap road = road_with({level_m(random), slope}, slab);
        EXPECT_NE(verdict(road, ahead(-2.0, 20.0), 0.2), Verdict::clear);
      }
    }
  }
}

TEST_P(SlabOnTheRoad, ThatIsLowAndInFrontIsAConflictAndNotRefused) {
  const OccupancyMap road = road_with(
      {0.05, GetParam()},
      Slab{.from_m = 10.0, .length_m = 0.3, .right_m = -0.3, .left_m = 0.3, .height_m = 0.4});
  EXPECT_EQ(verdict(road, ahead(-2.0, 20.0), 0.3), Verdict::conflict);
}

INSTANTIATE_TEST_SUITE_P(Slopes, SlabOnTheRoad, testing::Values(0.0, 0.08));

TEST(MeasuredGround, SaysWhereAndWhyItCannotBeTold) {
  const OccupancyMap road = road_with({}, Slab{.right_m = -4.0, .left_m = 4.0});
  try {
    map::measured_under(road, ahead(0.0, 20.0), {-1.0, 4.0});
    FAIL() << "the slab was taken for ground";
  } catch (const map::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("at (10.0, 0.0)"));
    EXPECT_THAT(error.what(), HasSubstr("columns are at the surface's height"));
  }
  EXPECT_THROW(map::measured_under(road, ahead(0.0, 6.0), {-9.0, 1.0}), map::InputError);
  EXPECT_THROW(map::measured_under(road, ahead(13.5, 30.0), {-1.0, 4.0}), map::InputError);
}

}  // namespace
}  // namespace roadbed::planning
