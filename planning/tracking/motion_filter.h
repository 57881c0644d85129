#pragma once

#include <Eigen/Core>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/planning/obstacles/foreseen_motion.h"

namespace roadbed::planning::inline tracking {

/// Standard deviations of what is measured of an object; white and Gaussian.
struct ObjectNoise {
  double position_m = 0.1;  ///< of each coordinate
  double heading_rad = 0.02;
  double speed_mps = 0.2;
};

/// An object as it is measured at one time.
struct MeasuredMotion {
  double t_s = 0.0;
  geometry::Pose2 pose;    ///< of its centre, in the map
  double speed_mps = 0.0;  ///< along its heading
};

/// Extended Kalman filter of one body that turns and speeds up steadily (CTRA): place, heading,
/// speed, acceleration and turn rate [Bar-Shalom, Li, Kirubarajan 2001, Estimation with
/// Applications to Tracking and Navigation, ch. 11]. The acceleration fades within 2 s [Singer
/// 1970, doi:10.1109/TAES.1970.310128], jerk and turn acceleration are white.
class MotionFilter {
 public:
  MotionFilter(const MeasuredMotion& first, const ObjectNoise& noise);

  /// Goes on to a later time. Without effect if it is not later.
  void predict(double to_s);

  /// Squared Mahalanobis distance of a measurement at the filter's time: of one object χ²
  /// distributed with four degrees of freedom.
  double misfit(const MeasuredMotion& measured) const;

  /// Takes a measurement at the filter's time.
  void update(const MeasuredMotion& measured);

  /// What is believed at the filter's time. Who becomes slower than its speed is known, and than
  /// 1 m/s, stands; it drives again when it is four
  /// deviations as fast, or 1 m/s, or farther away than four deviations and half a metre.
  SeenMotion state() const;

  /// Standard deviation of a coordinate, the larger one [m].
  double position_deviation_m() const;

 private:
  enum Index { kX, kY, kHeading, kSpeed, kAcceleration, kTurnRate, kSize };
  using State = Eigen::Matrix<double, kSize, 1>;
  using Covariance = Eigen::Matrix<double, kSize, kSize>;

  Eigen::Vector4d innovation(const MeasuredMotion& measured) const;
  Eigen::Matrix4d innovation_covariance() const;
  double speed_deviation_mps() const;
  void stand(bool stands);
  void tell_whether_it_stands();

  double t_s_;
  State state_;
  Covariance covariance_;
  Eigen::Vector4d noise_variance_;
  bool stands_;
  Eigen::Vector2d stands_at_;  ///< where it came to stand, as far as that was known
  double stands_at_deviation_m_;
};

}  // namespace roadbed::planning::tracking
