#pragma once

#include <vector>

#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::geometry::inline motion {

/// State of a vehicle at one time; the pose is that of the rear axle's centre.
struct TrajectoryPoint {
  double t_s = 0.0;
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;  ///< along the vehicle's x axis
  double steering_rad = 0.0;       ///< of the front axle, positive to the left
  double curvature_per_m = 0.0;    ///< of the rear axle's path, positive to the left

  Pose2 pose() const { return {x_m, y_m, heading_rad}; }
};

/// A drive: states at increasing times, headings unwrapped; between them every field is linear.
class Trajectory {
 public:
  Trajectory() = default;

  /// Unwraps the headings.
  /// @throws std::invalid_argument if there is no point, a value is not finite or time does not
  ///         increase.
  explicit Trajectory(std::vector<TrajectoryPoint> points);

  const std::vector<TrajectoryPoint>& points() const { return points_; }
  bool empty() const { return points_.empty(); }
  double start_s() const { return points_.front().t_s; }
  double end_s() const { return points_.back().t_s; }

  /// State at time `t_s`, clamped to the ends. O(log N).
  TrajectoryPoint at(double t_s) const;

 private:
  std::vector<TrajectoryPoint> points_;
};

/// State between two: `fraction` 0 is `a`, 1 is `b`; every field is linear.
TrajectoryPoint interpolate(const TrajectoryPoint& a, const TrajectoryPoint& b, double fraction);

}  // namespace roadbed::geometry::motion
