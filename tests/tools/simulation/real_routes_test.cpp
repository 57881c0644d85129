#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/cli/place.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {
namespace {

// Routes between random places on random driving lanes of other people's towns, without obstacles:
// lane changes, sharp turns in junctions, roads with gaps and bumps. ROADBED_ROUTES sets how many.
// Instrumented builds are many times slower, and the same code runs on every route.
#ifdef __SANITIZE_ADDRESS__
constexpr int kRoutes = 1;
#else
constexpr int kRoutes = 10;
#endif

int route_count() {
  const char* named = std::getenv("ROADBED_ROUTES");
  return named != nullptr ? std::atoi(named) : kRoutes;
}

map::LanePlace random_place(const map::RoadMap& road_map, std::mt19937& random) {
  std::vector<map::LaneId> drivable;
  for (const map::Lane& lane : road_map.lanes()) {
    if (map::is_drivable(lane.type) && !lane.polygon.empty()) drivable.push_back(lane.id);
  }
  const map::LaneId lane = drivable[random() % drivable.size()];
  const double fraction = static_cast<double>(1 + random() % 998) / 1000.0;
  return {.lane = lane, .s_m = fraction * road_map.lane(lane).length_m()};
}

std::string text_of(const map::RoadMap& road_map, const map::LanePlace& place) {
  return fmt::format("lane:{}@{:.3f}", road_map.lane(place.lane).name, place.s_m);
}

struct Trip {
  map::LanePlace from, to;
  planning::Route route;
};

Trip random_trip(const map::RoadMap& road_map, std::mt19937& random) {
  while (true) {
    const map::LanePlace from = random_place(road_map, random), to = random_place(road_map, random);
    planning::RouteAnswer answer = planning::find_route(road_map, from, to);
    if (answer.route && answer.route->length_m > 20.0) return {from, to, *std::move(answer.route)};
  }
}

struct Result {
  Drive drive;
  double worst_off_road_m = 0.0, worst_tracking_m = 0.0, worst_lateral_mps2 = 0.0;
  int replanned = 0, infeasible = 0;
};

Result measure(Drive drive) {
  Result result;
  for (const DriveSample& sample : drive.samples) {
    result.worst_off_road_m = std::max(result.worst_off_road_m, sample.off_road_m);
    result.worst_tracking_m = std::max(result.worst_tracking_m, std::abs(sample.cross_track_m));
  }
  for (const geometry::TrajectoryPoint& row : drive.trajectory.points()) {
    result.worst_lateral_mps2 = std::max(
        result.worst_lateral_mps2, std::abs(row.curvature_per_m) * row.speed_mps * row.speed_mps);
  }
  for (const DriveCycle& cycle : drive.cycles) {
    result.replanned += cycle.from_measurement ? 1 : 0;
    result.infeasible += cycle.chosen ? 0 : 1;
  }
  result.drive = std::move(drive);
  return result;
}

class RealRoutes : public testing::TestWithParam<const char*> {};

TEST_P(RealRoutes, AreDrivenToTheEndOnTheRoad) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const auto kept_map =
      Inputs().road_map(folder / "opendrive/BerkeleyLearnVerify+Scenic" / GetParam());
  const map::RoadMap& road_map = *kept_map;
  std::mt19937 random(20261121);
  for (int i = 0; i < route_count(); ++i) {
    Trip trip = random_trip(road_map, random);
    const std::string from = text_of(road_map, trip.from);
    const std::string name = fmt::format("{} {} -> {}", i, from, text_of(road_map, trip.to));
    fmt::print("{:<48} ", name);
    std::fflush(stdout);
    Scenario scenario;
    scenario.duration_s = std::min(3600.0, 60.0 + trip.route.length_m);
    planning::ReferenceLine line = planning::ReferenceLine::along(road_map, trip.route);
    World world{{.kept_map = kept_map,
                 .field = {},
                 .start = {},
                 .route = trip.route,
                 .line = std::move(line),
                 .obstacles = {}}};
    world.start = find_place(world.road_map, from).map_from_vehicle;
    const Result result = measure(drive(scenario, world));
    fmt::print(
        "{:7.1f} m {} changes | off {:.1f} m, track {:.2f} m, lat {:.2f} m/s², replanned "
        "{}, "
        "infeasible {} | {}\n",
        trip.route.length_m, trip.route.lane_changes, result.worst_off_road_m,
        result.worst_tracking_m, result.worst_lateral_mps2, result.replanned, result.infeasible,
        result.drive.verdict.text);
    std::fflush(stdout);
    EXPECT_EQ(result.drive.verdict.outcome, Outcome::goal_reached) << name;
    EXPECT_EQ(result.worst_off_road_m, 0.0) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Towns, RealRoutes,
                         testing::Values("Town01.xodr", "Town04.xodr", "Town10HD.xodr"));

}  // namespace
}  // namespace roadbed::tools
