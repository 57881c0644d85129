#include "roadbed/control/tracking_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::control {
namespace {

/// Rows of numbers under a line of names.
std::vector<std::vector<double>> read_rows(const std::filesystem::path& csv) {
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    rows.emplace_back(std::istream_iterator<double>(numbers), std::istream_iterator<double>());
  }
  return rows;
}

SampledPath read_course(const std::filesystem::path& csv) {
  std::vector<geometry::Pose2> poses;
  for (const auto& row : read_rows(csv)) poses.push_back({row.at(1), row.at(2), row.at(3)});
  return SampledPath(poses);
}

/// As the peer's runs were made.
TrackingOptions as_the_peer(SteeringLaw law, double speed_kmph) {
  TrackingOptions options{.law = law, .speed_mps = speed_kmph / 3.6, .step_s = 0.1, .euler = true};
  options.vehicle.wheelbase_m = 2.9;
  options.vehicle.max_steering_rad = std::numbers::pi / 6.0;
  return options;
}

struct PeerFigure {
  double speed_kmph, peer_rms_m, paper_rms_m;
};
constexpr std::array<PeerFigure, 4> kPeer{
    {{20, 0.096, 0.131}, {30, 0.203, 0.184}, {40, 0.341, 0.229}, {50, 0.508, 0.291}}};

TrackingSummary run(const SampledPath& path, const TrackingOptions& options) {
  return summarise(track_path(path, options));
}

// PythonRobotics' own run at 30 km/h (k = 0.5), rear axle.
TEST(TrackingRun, OriginalLawDrivesThePeersRun) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const SampledPath path = read_course(folder / "control/stanley_course.csv");
  const auto peer = read_rows(folder / "control/stanley_aligned_run.csv");
  const auto ours = track_path(path, as_the_peer(SteeringLaw::original_stanley, 30));
  ASSERT_GT(ours.size(), 200U);
  for (std::size_t k = 0; k < 200; ++k) {
    EXPECT_NEAR(ours[k].state.pose.x_m, peer[k].at(1), 0.05) << peer[k].at(0) << " s";
    EXPECT_NEAR(ours[k].state.pose.y_m, peer[k].at(2), 0.05);
    EXPECT_NEAR(ours[k].state.steering_rad, peer[k].at(5), 0.02);
  }
}

TEST(TrackingRun, PureLawsReachTheErrorsThatWereMeasured) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const SampledPath path = read_course(folder / "control/stanley_course.csv");
  for (const auto& [speed, peer_rms_m, paper_rms_m] : kPeer) {
    const auto original = run(path, as_the_peer(SteeringLaw::original_stanley, speed));
    const auto paper = run(path, as_the_peer(SteeringLaw::stanley, speed));
    EXPECT_NEAR(original.cross_track_rms_m, peer_rms_m, 0.002) << speed << " km/h";
    EXPECT_NEAR(paper.cross_track_rms_m, paper_rms_m, 0.002) << speed << " km/h";
  }
}

TEST(TrackingRun, HalfAStepOfPreviewHalvesThePeersErrorWithoutSteeringHarder) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const SampledPath path = read_course(folder / "control/stanley_course.csv");
  for (const auto& [speed, peer_rms_m, paper_rms_m] : kPeer) {
    TrackingOptions options = as_the_peer(SteeringLaw::stanley, speed);
    const double peer_rate =
        run(path, as_the_peer(SteeringLaw::original_stanley, speed)).steering_rate_rms_radps;
    options.preview_s = 0.5 * options.step_s;
    const auto ours = run(path, options);
    EXPECT_LT(ours.cross_track_rms_m, 0.5 * peer_rms_m) << speed << " km/h";
    EXPECT_LT(ours.steering_rate_rms_radps, 1.15 * peer_rate) << speed << " km/h";
    // A whole step would be as wrong as none: the delay is half a step, and nothing else.
    EXPECT_LT(ours.cross_track_rms_m, 0.05 * paper_rms_m) << speed << " km/h";
  }
}

SampledPath circle(double radius_m) {
  std::vector<geometry::Pose2> poses;
  for (int i = 0; i <= 600; ++i) {
    const double angle = 0.01 * i;
    poses.push_back({radius_m * std::sin(angle), radius_m * (1.0 - std::cos(angle)), angle});
  }
  return SampledPath(poses);
}

TEST(SampledPath, NearestStationIsTheArcFromTheStart) {
  const SampledPath path = circle(20.0);
  for (double angle = 0.3; angle < 5.5; angle += 0.37) {
    for (const double d_m : {-2.0, 0.0, 3.0}) {
      const double radius_m = 20.0 - d_m;
      const Eigen::Vector2d point(radius_m * std::sin(angle), 20.0 - radius_m * std::cos(angle));
      EXPECT_NEAR(path.nearest_s_m(point, 20.0 * angle + 3.0), 20.0 * angle,
                  0.03);  // chords of 0.2 m
    }
    EXPECT_NEAR(path.at(20.0 * angle).heading_rad, angle, 1e-4);
  }
}

TEST(SampledPath, LeadsStraightOnPastItsEnds) {
  const SampledPath path({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  EXPECT_DOUBLE_EQ(path.at(5.0).x_m, 5.0);
  EXPECT_DOUBLE_EQ(path.at(-1.5).x_m, -1.5);
  EXPECT_DOUBLE_EQ(path.nearest_s_m({4.0, 1.0}, 2.0), 4.0);
  EXPECT_DOUBLE_EQ(path.nearest_s_m({-3.0, 1.0}, 0.0), -3.0);
  EXPECT_THROW(SampledPath({{0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(SampledPath({{0, 0, 0}, {0, 0, 1}}), std::invalid_argument);
}

// The front axle on the circle: sin δ = L / R.
TEST(TrackingRun, EveryLawSettlesOnACircleAtTheSteeringAngleThatItAsksFor) {
  const double radius_m = 30.0;
  for (const SteeringLaw law :
       {SteeringLaw::stanley, SteeringLaw::original_stanley, SteeringLaw::pure_pursuit}) {
    const auto rows = track_path(circle(radius_m), {.law = law, .speed_mps = 5.0});
    const double asked = std::asin(geometry::VehicleShape{}.wheelbase_m / radius_m);
    const TrackingSample& settled = rows[4 * rows.size() / 5];
    EXPECT_NEAR(settled.state.steering_rad, asked, 0.003);
    EXPECT_LT(std::abs(settled.cross_track_m), 0.15);
    EXPECT_NEAR(settled.steering_rate_radps, 0.0, 0.01);
  }
}

TEST(TrackingRun, LateralJerkIsTheChangeOfLateralAcceleration) {
  const auto rows = track_path(circle(30.0), {.speed_mps = 5.0});
  const double wheelbase_m = geometry::VehicleShape{}.wheelbase_m;
  double acceleration_mps2 = 0.0;
  for (const TrackingSample& row : rows) {
    const double truth = 25.0 * std::tan(row.state.steering_rad) / wheelbase_m;
    EXPECT_NEAR(acceleration_mps2, truth, 1e-9) << row.t_s << " s";
    acceleration_mps2 += 0.01 * row.lateral_jerk_mps3;
  }
}

SampledPath straight(double length_m) { return SampledPath({{0, 0, 0}, {length_m, 0, 0}}); }

// Far from the wheels' limits e' = −v sin(atan(k e / v)): the error of eq. 31 falls as exp(−k t).
TEST(TrackingRun, OffsetFadesAtTheRateOfTheOriginalLaw) {
  for (const double speed : {10.0, 20.0}) {
    const auto run = track_path(
        straight(12.0 * speed),
        {.law = SteeringLaw::original_stanley, .speed_mps = speed, .start_offset_m = 0.5});
    EXPECT_NEAR(run.front().cross_track_m, -0.5, 1e-12);  // the path is to the right
    EXPECT_NEAR(run[900].cross_track_m / run[500].cross_track_m, std::exp(-0.5 * 4.0), 0.01);
  }
}

// Each axle carries its share of the lateral force, and its stiffness is in proportion to its load:
// both slip by v² κ / (μ C g), the rear axle outwards.
TEST(TrackingRun, SlippingRearAxleRunsInItsOwnDirectionOnACircle) {
  constexpr double kRadius_m = 60.0, kSpeed_mps = 12.0;
  std::vector<geometry::Pose2> circle;
  for (double a = 0.0; a < 4.0; a += 0.005) {
    circle.push_back({kRadius_m * std::sin(a), kRadius_m * (1.0 - std::cos(a)), a});
  }
  const DynamicVehicle car = common_road_vehicle(2);
  const auto run =
      track_path(SampledPath(circle), {.speed_mps = kSpeed_mps, .step_s = 0.01, .slips = car});
  const auto& [before, after] = std::pair(run[run.size() - 30].state, run[run.size() - 10].state);
  const Eigen::Vector2d moved = after.pose.position() - before.pose.position();
  const double middle_rad = 0.5 * (before.pose.heading_rad + after.pose.heading_rad);
  const double slip = geometry::wrap_angle(std::atan2(moved.y(), moved.x()) - middle_rad);
  const double stiffness = car.friction * car.cornering_stiffness_per_rad;
  EXPECT_NEAR(slip, -kSpeed_mps * kSpeed_mps / kRadius_m / (stiffness * 9.81), 5e-4);
}

TEST(TrackingRun, NoiseIsSeenByTheLawAndRepeatsWithItsSeed) {
  const auto driven = [](std::uint64_t seed) {
    return track_path(straight(40.0), {.position_noise_m = 0.05, .seed = seed});
  };
  EXPECT_EQ(driven(1).back().cross_track_m, driven(1).back().cross_track_m);
  EXPECT_NE(driven(1).back().cross_track_m, driven(2).back().cross_track_m);
  const TrackingSummary run = summarise(driven(1));
  EXPECT_LT(run.largest_cross_track_m, 0.02);  // the rows are the truth, not what was seen
  EXPECT_GT(run.steering_rate_rms_radps, 0.05);
}

TEST(TrackingRun, SpeedAndStepMustBePositive) {
  EXPECT_THROW(track_path(circle(30.0), {.speed_mps = 0.0}), std::invalid_argument);
  EXPECT_THROW(track_path(circle(30.0), {.step_s = std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::control
