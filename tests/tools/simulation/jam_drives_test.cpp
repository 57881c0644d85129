// Jams of two lanes, made by chance.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

constexpr double kDuration_s = 50.0;

double uniform(std::mt19937& random, double least, double most) {
  return least + (most - least) * static_cast<double>(random()) / 4294967296.0;
}

/// Drives, brakes, stands and sets off again at 1 or 2 m/s².
std::vector<TimedSpeed> stop_and_go(std::mt19937& random) {
  double t_s = 0.0, speed_mps = uniform(random, 0.0, 6.0);
  std::vector<TimedSpeed> speeds{{t_s, speed_mps}};
  while (t_s < kDuration_s) {
    const double next_mps = std::max(0.0, uniform(random, -4.0, 7.0));
    t_s += std::max(0.5, std::abs(next_mps - speed_mps) / (random() % 2 == 0 ? 1.0 : 2.0));
    speed_mps = next_mps;
    speeds.push_back({t_s, speed_mps});
    t_s += uniform(random, 0.5, 10.0);
    speeds.push_back({t_s, speed_mps});
  }
  return speeds;
}

/// The vehicle in the left one of two lanes, 94 m before its goal, cars ahead of it and beside it.
Scenario jam(unsigned seed) {
  std::mt19937 random(seed);
  Scenario scenario = read_scenario(tests::data_folder() / "scenarios" / "lane_change.json");
  scenario.start.text = "lane:31/0/-1@3";
  scenario.goal = {.text = "lane:31/0/-1@97", .pointer = "/goal"};
  scenario.start_speed_mps = uniform(random, 0.0, 6.0);
  scenario.duration_s = kDuration_s;
  scenario.obstacles.clear();
  for (const int lane : {-1, -2}) {
    const std::vector<TimedSpeed> speeds = stop_and_go(random);
    double s_m = lane == -1 ? uniform(random, 12.0, 22.0) : uniform(random, 5.0, 14.0);
    for (unsigned long left = 2 + random() % 3; left > 0; --left) {
      const std::string place = fmt::format("lane:31/0/{}@{:.1f}", lane, s_m);
      scenario.obstacles.push_back(
          {.id = fmt::format("{} at {:.0f}", lane == -1 ? "own" : "next", s_m),
           .motion = TrafficObstacle{{.text = place, .pointer = "/test"}, {}, speeds}});
      s_m += uniform(random, 7.0, 14.0);
    }
  }
  return scenario;
}

TEST(JamDrives, NobodyIsTouchedNorPassedOnTheWrongSide) {
  for (unsigned seed = 1; seed <= 24; ++seed) {
    const Scenario scenario = jam(1 + (seed - 1) / 2);
    const bool predicts = seed % 2 == 0;
    World world = make_world(scenario);
    const Drive drive = tools::drive(scenario, world, {.predicts = predicts});
    EXPECT_NE(drive.verdict.outcome, Outcome::collision)
        << "seed " << seed << ": " << drive.verdict.text;
    for (const DriveSample& sample : drive.samples) {
      ASSERT_GT(sample.clearance_m, 0.0) << "seed " << seed;
    }
    if (predicts) continue;  // who has stood for 15 s is taken for parked, on either side
    const auto blocked = std::ranges::find_if(drive.events, [](const DriveEvent& event) {
      return event.text.starts_with("the road is blocked");
    });
    const double until_s =
        blocked == drive.events.end() ? 1e9 : blocked->t_s;  // as is who blocks it
    for (const auto& row : drive.trajectory.points()) {
      if (row.t_s > until_s) break;
      const double d_m = world.line.project(row.pose().position()).d_m;
      ASSERT_GT(d_m, -0.9) << "seed " << seed << ", in the right lane at " << row.t_s << " s";
    }
  }
}

}  // namespace
}  // namespace roadbed::tools
