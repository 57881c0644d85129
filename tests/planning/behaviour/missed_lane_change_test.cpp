// A lane change for which nobody leaves a gap, in the closed loop.
#include "roadbed/planning/behaviour/missed_lane_change.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "roadbed/tests/support/made_lanelet2.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {
namespace {

using testing::HasSubstr;
using tests::MadeLanelet2;

constexpr double kChangesUntil_m = 300.0, kCar_m = 4.5;

/// Two lanes eastwards, whose left one leads to the goal. The right one goes on, too: at its own
/// limit, straight on and into the other one, or not at all.
///
///     y = 6 ──────────── beside ─────────────┬───────── straight ─────────┬──── goal
///     y = 3 ─ ─ ─ ─ ─ ─ ─ own ─ ─ ─ ─ ─ ─ ─ ─┼──────── by another way ────╯
///     y = 0 ─────────────────────────────────┴────────────────────────
///         x = 0                             300                          600, 640
struct Roads {
  std::string other_way_kmh;  ///< empty: the right lane ends
  std::string own_kmh = "50";
};

std::filesystem::path map_file(const Roads& roads) {
  MadeLanelet2 made;
  const auto tags = [](const std::string& kmh) {
    return MadeLanelet2::Tags{
        {"subtype", "road"}, {"speed_limit", kmh}, {"one_way", "yes"}, {"location", "urban"}};
  };
  const auto node = [&](double x_m, double y_m) { return made.node({x_m, y_m}); };
  const auto solid = [&](std::int64_t from, std::int64_t to) {
    return made.way({from, to}, {{"type", "line_thin"}, {"subtype", "solid"}});
  };
  std::int64_t at_0[3], at_300[3], at_600[3];
  for (int i = 0; i < 3; ++i) {
    at_0[i] = node(0, 3 * i);
    at_300[i] = node(kChangesUntil_m, 3 * i);
    at_600[i] = node(600, 3 * i);
  }
  const auto dashed =
      made.way({at_0[1], at_300[1]}, {{"type", "line_thin"}, {"subtype", "dashed"}});
  made.lanelet(dashed, solid(at_0[0], at_300[0]), tags(roads.own_kmh));
  made.lanelet(solid(at_0[2], at_300[2]), dashed, tags(roads.own_kmh));
  const auto between = solid(at_300[1], at_600[1]);
  made.lanelet(solid(at_300[2], at_600[2]), between, tags("50"));
  const auto left = node(640, 6), right = node(640, 3);
  made.lanelet(solid(at_600[2], left), solid(at_600[1], right), tags("50"));
  made.lanelet(solid(left, node(2500, 6)), solid(right, node(2500, 3)), tags("50"));
  if (!roads.other_way_kmh.empty()) {
    made.lanelet(between, solid(at_300[0], at_600[0]), tags(roads.other_way_kmh));
    made.lanelet(solid(at_600[1], left), solid(at_600[0], right), tags("30"));
  }
  const auto path =
      std::filesystem::path(testing::TempDir()) / fmt::format("missed_change_{}.osm", ::getpid());
  std::ofstream(path) << made.text();
  return path;
}

ScenarioPlace place(double x_m, double y_m) {
  return {.text = fmt::format("{},{},0", x_m, y_m), .pointer = "/test"};
}

/// Cars in the left lane with a gap in which nobody fits.
Drive drive_beside_others(const Roads& roads, double others_mps, double gap_m = 8.0) {
  Scenario scenario;
  scenario.file = "missed.json";
  scenario.map_file = map_file(roads);
  scenario.start = place(60.0, 1.5);
  scenario.goal = place(880.0, 4.5);
  scenario.start_speed_mps = others_mps;
  scenario.duration_s = 120.0;
  scenario.options.desired_speed_mps = 13.0;
  for (double x_m = 295.0; x_m > 5.0; x_m -= gap_m + kCar_m) {
    scenario.obstacles.push_back(
        {.id = fmt::format("car {}", scenario.obstacles.size()),
         .length_m = kCar_m,
         .motion = TrafficObstacle{place(x_m, 4.5), {}, {{0.0, others_mps}}}});
  }
  World world = make_world(scenario);
  return drive(scenario, world);
}

double least_mps_before(const Drive& driven, double x_m) {
  double least_mps = 1e9;
  for (const auto& row : driven.trajectory.points()) {
    if (row.x_m < x_m) least_mps = std::min(least_mps, row.speed_mps);
  }
  return least_mps;
}

std::string news_of(const Drive& driven) {
  std::string news;
  for (const DriveCycle& cycle : driven.cycles) {
    if (cycle.is_news) news += cycle.reason + "\n";
  }
  return news;
}

TEST(MissedLaneChange, TheVehicleDrivesOnByAnotherWayThatIsLittleLonger) {
  const Drive driven = drive_beside_others({.other_way_kmh = "30"}, 10.0);
  EXPECT_EQ(driven.verdict.outcome, Outcome::goal_reached) << driven.verdict.text;
  EXPECT_THAT(news_of(driven), HasSubstr("nobody leaves a gap for the lane change; another route"));
  EXPECT_GT(least_mps_before(driven, kChangesUntil_m), 5.0) << "it did not wait";
}

TEST(MissedLaneChange, TheVehicleWaitsWhereTheLaneDoesNotGoOn) {
  const Drive driven = drive_beside_others({.other_way_kmh = ""}, 10.0);
  EXPECT_EQ(driven.verdict.outcome, Outcome::goal_reached) << driven.verdict.text;
  EXPECT_EQ(news_of(driven), "");
  EXPECT_LT(least_mps_before(driven, kChangesUntil_m), 2.0);
}

}  // namespace
}  // namespace roadbed::tools
