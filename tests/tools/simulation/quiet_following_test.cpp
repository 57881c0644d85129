// How quietly a lead is followed: of the true acceleration, at the trajectory's rows of 0.1 s.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/straight_world.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools {
namespace {

constexpr double kRow_s = 0.1;
constexpr double kSigned_mps2 = 0.01;  // less has no sign: in bends gaps are known to a few cm

/// Accelerations of the rows within a span of time.
std::vector<double> accelerations(const Drive& drive, double from_s, double to_s) {
  std::vector<double> found;
  for (const geometry::TrajectoryPoint& row : drive.trajectory.points()) {
    if (row.t_s >= from_s - 1e-9 && row.t_s <= to_s + 1e-9) found.push_back(row.acceleration_mps2);
  }
  return found;
}

double jerk_rms_mps3(const std::vector<double>& a_mps2) {
  double squares = 0.0;
  for (std::size_t i = 1; i < a_mps2.size(); ++i) {
    squares += std::pow((a_mps2[i] - a_mps2[i - 1]) / kRow_s, 2);
  }
  return std::sqrt(squares / static_cast<double>(a_mps2.size() - 1));
}

/// The most sign changes in any 10 s.
int most_sign_changes(const std::vector<double>& a_mps2) {
  std::vector<std::size_t> changes;
  double last = 0.0;
  for (std::size_t i = 0; i < a_mps2.size(); ++i) {
    if (std::abs(a_mps2[i]) < kSigned_mps2) continue;
    if (a_mps2[i] * last < 0.0) changes.push_back(i);
    last = a_mps2[i];
  }
  std::ptrdiff_t most = 0;
  for (auto first = changes.begin(); first != changes.end(); ++first) {
    most = std::max(most, std::ranges::lower_bound(first, changes.end(), *first + 100) - first);
  }
  return static_cast<int>(most);
}

double largest_mps2(const std::vector<double>& a_mps2) {
  double largest = 0.0;
  for (const double a : a_mps2) largest = std::max(largest, std::abs(a));
  return largest;
}

struct Following {
  std::string name;
  double start_mps, desired_mps, lead_x_m;  ///< the ego starts at x = 10 m
  std::vector<TimedSpeed> lead;
};

const std::vector<Following> kSettling{
    {"4 m/s, from afar", 10.0, 12.0, 110.0, {{0.0, 4.0}}},
    {"6.5 m/s, near", 12.0, 12.0, 60.0, {{0.0, 6.5}}},
    {"12 m/s", 15.0, 20.0, 60.0, {{0.0, 12.0}}},
    {"hardly slower than desired", 12.0, 12.2, 40.0, {{0.0, 12.0}}},
    {"cut in", 20.0, 20.0, 35.0, {{0.0, 12.0}}},
    {"has sped up", 8.0, 25.0, 50.0, {{0.0, 6.0}, {8.0, 6.0}, {12.0, 10.0}}},
    {"has braked", 14.0, 25.0, 50.0, {{0.0, 14.0}, {8.0, 14.0}, {12.0, 6.0}}}};

Drive followed(const Following& following, const ScenarioNoise& noise = {}, int seed = 1) {
  planning::Obstacle lead{.id = "lead", .motion = {}};
  lead.motion = drive_along(
      [&](double distance_m) {
        return geometry::Pose2{following.lead_x_m + distance_m, 0.0, 0.0};
      },
      1e4, following.lead, 120.0);
  World world =
      tests::straight_world({.to_x_m = 2500.0, .start_x_m = 10.0, .goal_x_m = 2400.0}, {lead});
  Scenario scenario;
  scenario.start_speed_mps = following.start_mps;
  scenario.options.desired_speed_mps = following.desired_mps;
  scenario.duration_s = 60.0;
  scenario.noise = noise;
  scenario.seed = static_cast<std::uint64_t>(seed);
  return tools::drive(scenario, world);
}

const ScenarioNoise kNoise{.gap_m = 0.25,
                           .relative_speed_mps = 0.1,
                           .acceleration_mps2 = 0.05,
                           .position_m = 0.02,
                           .heading_rad = 0.001,
                           .speed_mps = 0.05};

TEST(QuietFollowing, SettledItHardlyJerksAndDoesNotSwing) {
  for (const Following& following : kSettling) {
    const auto settled = accelerations(followed(following), 30.0, 60.0);
    ASSERT_EQ(settled.size(), 301U) << following.name;
    EXPECT_LE(jerk_rms_mps3(settled), 0.01) << following.name;
    EXPECT_LE(most_sign_changes(settled), 2) << following.name;
  }
}

TEST(QuietFollowing, ApproachHasOneBrakingAndNoSwing) {
  for (const Following& following : kSettling) {
    const auto whole = accelerations(followed(following), 0.0, 60.0);
    EXPECT_LE(most_sign_changes(whole), 2) << following.name;
  }
}

TEST(QuietFollowing, MeasurementNoiseIsHardlyFelt) {
  for (const Following& following : kSettling) {
    for (int seed = 1; seed <= 4; ++seed) {
      const auto settled = accelerations(followed(following, kNoise, seed), 30.0, 60.0);
      ASSERT_EQ(settled.size(), 301U) << following.name;
      EXPECT_LE(jerk_rms_mps3(settled), 0.15) << following.name << ", seed " << seed;
    }
  }
}

TEST(QuietFollowing, LeadThatSwingsIsFollowedWithLessThanItsJerk) {
  constexpr double kAmplitude_mps = 1.5, kRate_radps = 0.4;
  std::vector<TimedSpeed> wave;
  for (double t = 0.0; t < 70.0; t += 0.5) {
    wave.push_back({t, 12.0 + kAmplitude_mps * std::sin(kRate_radps * t)});
  }
  const auto settled = accelerations(followed({"wave", 12.0, 20.0, 45.0, wave}), 25.0, 60.0);
  EXPECT_LE(most_sign_changes(settled), 2);
  EXPECT_LT(jerk_rms_mps3(settled), kAmplitude_mps * kRate_radps * kRate_radps / std::sqrt(2.0));
}

TEST(QuietFollowing, ApproachFromAfarIsComfortable) {
  for (const double closing_mps : {3.0, 5.0, 8.0, 11.0}) {
    const double lead_mps = 13.0 - closing_mps;  // the road's limit is 13.9 m/s
    const Drive drive = followed({"", 13.0, 13.0, 150.0, {{0.0, lead_mps}}});
    EXPECT_LE(largest_mps2(accelerations(drive, 0.0, 60.0)), 1.6) << closing_mps << " m/s";
    const auto& last = drive.cycles.back();
    ASSERT_TRUE(last.lead);
    EXPECT_NEAR(last.lead->gap_m, 5.0 + 1.5 * lead_mps, 0.1) << closing_mps << " m/s";
  }
}

/// The town drive behind its slower car, between the first approach and the roundabout.
std::vector<double> behind_the_slower_car(const ScenarioNoise& noise, int seed) {
  Scenario scenario = read_scenario(tests::data_folder() / "drive.json");
  scenario.noise = noise;
  scenario.seed = static_cast<std::uint64_t>(seed);
  scenario.duration_s = 42.0;
  World world = make_world(scenario);
  return accelerations(tools::drive(scenario, world), 28.0, 42.0);
}

TEST(QuietFollowing, TownDriveIsQuietBehindTheSlowerCar) {
  const auto quiet = behind_the_slower_car({}, 1);
  ASSERT_EQ(quiet.size(), 141U);
  EXPECT_LE(jerk_rms_mps3(quiet), 0.1);
  EXPECT_LE(most_sign_changes(quiet), 2);
  for (int seed = 1; seed <= 3; ++seed) {
    EXPECT_LE(jerk_rms_mps3(behind_the_slower_car(kNoise, seed)), 0.2) << "seed " << seed;
  }
}

/// Past a cyclist whom the end of the path comes near now and then.
TEST(QuietFollowing, TownDriveKeepsToABehaviourOnceItIsBegun) {
  Scenario scenario = read_scenario(tests::data_folder() / "drive.json");
  scenario.duration_s = 18.0;
  World world = make_world(scenario);
  const Drive drive = tools::drive(scenario, world);
  std::size_t begun = 0;
  for (std::size_t i = 1; i < drive.cycles.size(); ++i) {
    if (drive.cycles[i].behaviour == drive.cycles[i - 1].behaviour) continue;
    EXPECT_GE(i - begun, 10U) << "until " << drive.cycles[i].t_s << " s";
    begun = i;
  }
  EXPECT_GT(begun, 0U);
}

}  // namespace
}  // namespace roadbed::tools
