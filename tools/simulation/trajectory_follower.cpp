#include "roadbed/tools/simulation/trajectory_follower.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "roadbed/geometry/motion/longitudinal.h"
#include "roadbed/planning/speed/speed_controller.h"

namespace roadbed::tools::inline simulation {
namespace {

constexpr double kSpeedTime_s = 1.0, kPlaceTime_s = 2.0;
constexpr double kHardestBraking_mps2 = 8.0, kBrakingPastEnd_mps2 = 3.0;
constexpr double kSetsOffWithin_s = 1.0;
constexpr double kStanding_mps = 0.05, kRolling_mps = 0.3, kHolding_mps2 = 1.0;
constexpr double kLeastStep_m = 1e-3;

// Of the path between two rows: what the headings turn over the way, which needs no column of its
// own.
double bend_per_m(const geometry::TrajectoryPoint& a, const geometry::TrajectoryPoint& b) {
  const double way_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
  return way_m < kLeastStep_m ? 0.0 : (b.heading_rad - a.heading_rad) / way_m;
}

control::SampledPath front_path(const geometry::Trajectory& trajectory, double wheelbase_m) {
  const std::vector<geometry::TrajectoryPoint>& rows = trajectory.points();
  std::vector<geometry::Pose2> poses;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t from = i + 1 < rows.size() ? i : i - std::min<std::size_t>(i, 1);
    const double bend = rows.size() > 1 ? bend_per_m(rows[from], rows[from + 1]) : 0.0;
    const Eigen::Vector2d front = rows[i].pose() * Eigen::Vector2d(wheelbase_m, 0.0);
    const bool is_new = poses.empty() || (poses.back().position() - front).norm() > kLeastStep_m;
    if (!is_new) continue;
    poses.push_back({front.x(), front.y(), rows[i].heading_rad + std::atan(wheelbase_m * bend)});
  }
  if (poses.size() == 1) {
    const Eigen::Vector2d ahead = poses.front() * Eigen::Vector2d(1.0, 0.0);
    poses.push_back({ahead.x(), ahead.y(), poses.front().heading_rad});
  }
  return control::SampledPath(std::move(poses));
}

geometry::Trajectory checked(geometry::Trajectory trajectory) {
  if (!trajectory.empty()) return trajectory;
  throw std::invalid_argument("TrajectoryFollower: the trajectory is empty");
}

}  // namespace

TrajectoryFollower::TrajectoryFollower(geometry::Trajectory trajectory,
                                       const geometry::VehicleShape& vehicle)
    : trajectory_(checked(std::move(trajectory))),
      wheelbase_m_(vehicle.wheelbase_m),
      front_(front_path(trajectory_, vehicle.wheelbase_m)) {}

control::TrackingError TrajectoryFollower::error_of(const geometry::Pose2& pose) {
  const Eigen::Vector2d front = pose * Eigen::Vector2d(wheelbase_m_, 0.0);
  front_s_m_ = front_.nearest_s_m(front, front_s_m_);
  return control::tracking_error(pose, wheelbase_m_, front_.at(front_s_m_));
}

double TrajectoryFollower::acceleration_mps2(double t_s, const geometry::Pose2& pose,
                                             double speed_mps) const {
  if (t_s > trajectory_.end_s()) return speed_mps > 0.0 ? -kBrakingPastEnd_mps2 : 0.0;
  constexpr double over_s = 0.1;
  const double ahead_s = t_s + geometry::kLongitudinal.actuator_lag_s;
  const double planned_mps2 = (trajectory_.at(ahead_s + 0.5 * over_s).speed_mps -
                               trajectory_.at(ahead_s - 0.5 * over_s).speed_mps) /
                              over_s;
  const geometry::TrajectoryPoint wanted = trajectory_.at(t_s);
  const bool stays = wanted.speed_mps < kStanding_mps &&
                     trajectory_.at(t_s + kSetsOffWithin_s).speed_mps < kStanding_mps;
  if (stays && speed_mps < kRolling_mps) return -kHolding_mps2;
  const Eigen::Vector2d direction(std::cos(pose.heading_rad), std::sin(pose.heading_rad));
  const double behind_m = (wanted.pose().position() - pose.position()).dot(direction);
  const double command = planned_mps2 + (wanted.speed_mps - speed_mps) / kSpeedTime_s +
                         behind_m / (kPlaceTime_s * kPlaceTime_s);
  return std::clamp(command, -kHardestBraking_mps2, planning::kMostCommand_mps2);
}

}  // namespace roadbed::tools::simulation
