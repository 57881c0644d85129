// A lane change for which nobody leaves a gap, in the closed loop.
#include "roadbed/planning/behaviour/missed_lane_change.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "roadbed/tests/support/made_lanelet2.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {
namespace {

using tests::MadeLanelet2;

constexpr double kChangesUntil_m = 300.0, kCar_m = 4.5;

/// Two lanes eastwards, of which the left one leads to the goal, beyond x = 640. From x = 300 on
/// they are apart: the right one ends, or comes to the goal by another way, at a limit of its own.
///
///     y = 6 ──────────────────────┬───────────────────────┬───────┬────────
///              to be changed to        straight on               ▶ goal
///     y = 3 ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ┼───────────────────────┼───────┴────────
///              ▶ own lane              another way        ╱
///     y = 0 ──────────────────────┴───────────────────────╯
///         x = 0                  300                     600     640
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
  const auto column = [&](double x_m) {
    return std::array{node(x_m, 0), node(x_m, 3), node(x_m, 6)};
  };
  const auto at_0 = column(0), at_300 = column(kChangesUntil_m), at_600 = column(600);
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

/// Cars in the left lane, and the vehicle as fast as they are.
struct Others {
  double speed_mps = 10.0;
  double gap_m = 8.0;  ///< bumper to bumper: nobody fits in
};

Drive drive_beside(const Others& others, const Roads& roads) {
  Scenario scenario;
  scenario.file = "missed.json";
  scenario.map_file = map_file(roads);
  scenario.start = place(60.0, 1.5);
  scenario.goal = place(880.0, 4.5);
  scenario.start_speed_mps = others.speed_mps;
  scenario.duration_s = 120.0;
  scenario.options.desired_speed_mps = 13.0;
  for (double x_m = 295.0; x_m > 5.0; x_m -= others.gap_m + kCar_m) {
    scenario.obstacles.push_back(
        {.id = fmt::format("car {}", scenario.obstacles.size()),
         .length_m = kCar_m,
         .motion = TrafficObstacle{place(x_m, 4.5), {}, {{0.0, others.speed_mps}}}});
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

constexpr const char* kOtherWay = "nobody leaves a gap for the lane change; another route";

/// When another route is taken; none: never.
std::optional<double> other_way_at_s(const Drive& driven) {
  for (const DriveCycle& cycle : driven.cycles) {
    if (cycle.is_news && cycle.reason.starts_with(kOtherWay)) return cycle.t_s;
  }
  return std::nullopt;
}

/// When it first stands; none: never.
std::optional<double> stands_at_s(const Drive& driven) {
  for (const auto& row : driven.trajectory.points()) {
    if (row.speed_mps < 0.05) return row.t_s;
  }
  return std::nullopt;
}

TEST(MissedLaneChange, TheVehicleDrivesOnByAnotherWayThatIsLittleLonger) {
  const Drive driven = drive_beside({}, {.other_way_kmh = "30"});
  EXPECT_EQ(driven.verdict.outcome, Outcome::goal_reached) << driven.verdict.text;
  EXPECT_TRUE(other_way_at_s(driven));
  EXPECT_GT(least_mps_before(driven, kChangesUntil_m), 5.0) << "it did not wait";
}

TEST(MissedLaneChange, TheVehicleWaitsWhereTheLaneEndsOrTheOtherWayIsMuchLonger) {
  for (const char* other_way_kmh : {"", "5"}) {  // 300 m: 22 s at 50 km/h, 216 s at 5 km/h
    SCOPED_TRACE(other_way_kmh);
    const Drive driven = drive_beside({}, {.other_way_kmh = other_way_kmh});
    EXPECT_EQ(driven.verdict.outcome, Outcome::goal_reached) << driven.verdict.text;
    EXPECT_FALSE(other_way_at_s(driven));
    EXPECT_LT(least_mps_before(driven, kChangesUntil_m), 2.0);
  }
}

TEST(MissedLaneChange, NobodyWaitsWhereMoreThanSixtyAreAllowedHoweverSlowlyItDrives) {
  EXPECT_TRUE(other_way_at_s(drive_beside({}, {.other_way_kmh = "5", .own_kmh = "61"})));
  EXPECT_FALSE(other_way_at_s(drive_beside({}, {.other_way_kmh = "5", .own_kmh = "59"})));
}

TEST(MissedLaneChange, AfterAMinuteAnyWayIsTaken) {
  const Others slow{.speed_mps = 2.0, .gap_m = 4.0};
  const Drive driven = drive_beside(slow, {.other_way_kmh = "5"});
  ASSERT_TRUE(stands_at_s(driven));
  ASSERT_TRUE(other_way_at_s(driven));
  EXPECT_NEAR(*other_way_at_s(driven) - *stands_at_s(driven), 60.0, 2.0);
}

}  // namespace
}  // namespace roadbed::tools
