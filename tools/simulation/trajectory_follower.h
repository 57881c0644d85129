#pragma once

#include <memory>

#include "roadbed/control/sampled_path.h"
#include "roadbed/control/stanley.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"

namespace roadbed::tools::inline simulation {

/// Follows a trajectory: steering by the errors of the front axle against the path that it draws,
/// speed by time. Frame and time are the trajectory's.
///
///     u = a(t + T_L) + (v(t) − v) / 1 s + Δs / (2 s)²,   Δs: how far the trajectory is ahead
///
/// with the trajectory's acceleration a one actuator's lag T_L ahead. Past its end it brakes to a
/// stop at 3 m/s²; where the trajectory stands for a second and the vehicle nearly does, it brakes
/// at 1 m/s².
class TrajectoryFollower {
 public:
  /// Of a trajectory that does not move, the path leads straight on.
  /// @throws std::invalid_argument if it is empty.
  TrajectoryFollower(geometry::Trajectory trajectory, const geometry::VehicleShape& vehicle);

  const geometry::Trajectory& trajectory() const { return trajectory_; }

  /// The path's nearest place is searched near the one of the call before.
  control::TrackingError error_of(const geometry::Pose2& pose);

  /// Desired acceleration, −8 m/s² at least.
  double acceleration_mps2(double t_s, const geometry::Pose2& pose, double speed_mps) const;

 private:
  geometry::Trajectory trajectory_;
  double wheelbase_m_;
  control::SampledPath front_;  ///< that the front axle draws
  double front_s_m_ = 0.0;
};

}  // namespace roadbed::tools::simulation
