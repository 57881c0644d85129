// Those who drive along lanes keep a distance from whoever is ahead, the vehicle included.
#include "roadbed/tools/simulation/traffic_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {
namespace {

constexpr double kLength_m = 4.5;  // of every car here

LaneDriver on_x_axis(const std::string& id, double from_m, std::vector<TimedSpeed> speeds) {
  return {.obstacle = id,
          .way =
              [from_m](double s_m) {
                return geometry::Pose2{from_m + s_m, 0.0, 0.0};
              },
          .way_length_m = 5000.0,
          .place_of =
              [from_m](const Eigen::Vector2d& point) {
                return geometry::LinePosition{point.x() - from_m, point.y()};
              },
          .speeds = std::move(speeds)};
}

DrivenBody vehicle_at(double x_m, double y_m, double speed_mps) {
  return {{.centre = {x_m, y_m}, .axis = {1, 0}, .half_length_m = 2.25, .half_width_m = 0.9},
          speed_mps};
}

/// Cars behind one another, and the vehicle as `vehicle` says by time; bumper to bumper afterwards.
struct Platoon {
  std::vector<LaneDriver> drivers;
  std::vector<planning::Obstacle> obstacles;

  template <typename Vehicle>
  double least_gap_m(int steps, const Vehicle& vehicle) {
    for (const LaneDriver& driver : drivers)
      obstacles.push_back({.id = driver.obstacle, .motion = {}});
    TrafficFlow flow(drivers, obstacles, 0.1 * steps, {});
    double least_m = 1e9;
    for (int k = 0; k < steps; ++k) {
      std::vector<double> x{vehicle(0.1 * k).body.centre.x()};
      for (const auto& obstacle : obstacles) x.push_back(obstacle.motion.at(0.1 * k).x_m);
      std::ranges::sort(x);
      for (std::size_t i = 1; i < x.size(); ++i)
        least_m = std::min(least_m, x[i] - x[i - 1] - kLength_m);
      flow.step(vehicle(0.1 * k));
    }
    return least_m;
  }
  double speed_at(std::size_t car, double t_s) const {
    return obstacles[car].motion.at(t_s).speed_mps;
  }
};

TEST(TrafficFlow, FutureIsKnownBeyondTheEndOfTheDrive) {
  Scenario scenario = read_scenario(tests::data_folder() / "scenarios" / "pass_lorry.json");
  scenario.duration_s = 20.0;
  const World world = make_world(scenario);
  const geometry::Trajectory& lorry = world.obstacles.front().motion;
  const Eigen::Vector2d at_end = lorry.at(scenario.duration_s).pose().position();
  const Eigen::Vector2d later = lorry.at(scenario.duration_s + 8.0).pose().position();
  EXPECT_NEAR((later - at_end).norm(), 8.0 * 4.0, 0.1);
}

TEST(TrafficFlow, CarsStopBehindTheVehicleThatStopsAndDriveOnBehindIt) {
  Platoon cars{
      .drivers = {on_x_axis("a", 160.0, {{0.0, 15.0}}), on_x_axis("b", 120.0, {{0.0, 15.0}}),
                  on_x_axis("c", 60.0, {{0.0, 20.0}})},
      .obstacles = {}};
  // 12 m/s, from 5 s on braked by 3 m/s² to a stand for 10 s, then 1.5 m/s² up to 12 m/s.
  const auto speed = [](double t_s) {
    if (t_s < 5.0) return 12.0;
    if (t_s < 19.0) return std::max(0.0, 12.0 - 3.0 * (t_s - 5.0));
    return std::min(12.0, 1.5 * (t_s - 19.0));
  };
  double x_m = 200.0, until_s = 0.0;
  const double least_m = cars.least_gap_m(600, [&](double t_s) {
    for (; until_s < t_s - 1e-9; until_s += 0.1) x_m += 0.1 * speed(until_s);
    return vehicle_at(x_m, 0.0, speed(t_s));
  });
  EXPECT_GT(least_m, 1.5);  // 2 m is the gap at a stand
  for (std::size_t car = 0; car < 3; ++car) {
    EXPECT_LT(cars.speed_at(car, 18.0), 0.3) << car;
    EXPECT_GT(cars.speed_at(car, 55.0), 11.0) << car;
    EXPECT_LT(cars.speed_at(car, 55.0), 13.0) << car;
  }
}

TEST(TrafficFlow, WhoIsNotHinderedDrivesExactlyAsItsSpeedsSay) {
  const std::vector<TimedSpeed> speeds{{0.0, 8.0}, {3.0, 8.0}, {6.0, 14.0}, {12.0, 2.0}};
  Platoon cars{.drivers = {on_x_axis("a", 0.0, speeds)}, .obstacles = {}};
  cars.least_gap_m(200, [](double) { return vehicle_at(60.0, 3.5, 0.0); });  // in the other lane
  const auto expected = drive_along(cars.drivers[0].way, 5000.0, speeds, 20.0);
  for (double t_s = 0.0; t_s < 20.0; t_s += 0.1) {
    EXPECT_EQ(cars.obstacles[0].motion.at(t_s).x_m, expected.at(t_s).x_m) << t_s;
  }
}

// On a bridge over the vehicle's route, say: away for the vehicle, not for one another.
TEST(TrafficFlow, WhoIsAwayFromTheRouteIsAheadOfOthers) {
  std::vector<planning::Obstacle> obstacles{{.id = "slow", .motion = {}, .away = planning::kAlways},
                                            {.id = "fast", .motion = {}}};
  const std::vector<LaneDriver> drivers{on_x_axis("slow", 60.0, {{0.0, 5.0}}),
                                        on_x_axis("fast", 0.0, {{0.0, 20.0}})};
  TrafficFlow flow(drivers, obstacles, 20.0, {});
  for (int k = 0; k < 200; ++k) {
    obstacles.front().away = planning::kAlways;
    flow.step(vehicle_at(-1000.0, 500.0, 0.0));
  }
  const auto x_m = [&](std::size_t car) { return obstacles[car].motion.at(20.0).x_m; };
  EXPECT_GT(x_m(0) - x_m(1), kLength_m);
}

TEST(TrafficFlow, FollowerSettlesAtTheModelsEquilibrium) {
  Platoon cars{.drivers = {on_x_axis("a", 0.0, {{0.0, 20.0}})}, .obstacles = {}};
  double gap_m = 0.0;
  cars.least_gap_m(900, [](double t_s) { return vehicle_at(50.0 + 10.0 * t_s, 0.0, 10.0); });
  gap_m = 50.0 + 10.0 * 89.0 - cars.obstacles[0].motion.at(89.0).x_m - kLength_m;
  EXPECT_NEAR(gap_m, 2.0 + 1.2 * 10.0, 0.5);  // s₀ + T v
  EXPECT_NEAR(cars.speed_at(0, 89.0), 10.0, 0.1);
}

TEST(TrafficFlow, FasterTrafficBehindASlowVehicleBrakesInADrive) {
  Scenario scenario = read_scenario(tests::data_folder() / "scenarios" / "overtake.json");
  scenario.options.desired_speed_mps = 7.0;
  scenario.start.text = "lane:1/0/-1@100";
  scenario.start_speed_mps = 7.0;
  scenario.duration_s = 40.0;
  scenario.obstacles = {
      {.id = "tail",
       .motion = TrafficObstacle{{"lane:1/0/-1@30", ""}, std::nullopt, {{0.0, 16.0}}}}};
  World world = make_world(scenario);
  const Drive driven = drive(scenario, world);
  EXPECT_NE(driven.verdict.outcome, Outcome::collision) << driven.verdict.text;
  for (const DriveSample& sample : driven.samples) EXPECT_GT(sample.clearance_m, 2.0) << sample.t_s;
  EXPECT_NEAR(world.obstacles[0].motion.at(39.0).speed_mps, 7.0, 0.3);
}

}  // namespace
}  // namespace roadbed::tools
