#include "roadbed/control/stanley.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::control {
namespace {

double limited(double steering_rad, const geometry::VehicleShape& vehicle) {
  return std::clamp(steering_rad, -vehicle.max_steering_rad, vehicle.max_steering_rad);
}

}  // namespace

double look_forward_m(double speed_mps) { return std::clamp(0.8 * speed_mps, 10.0, 20.0); }

double cross_track_gain(double speed_mps) { return std::min(1.0, 0.5 + 0.02 * speed_mps); }

TrackingError tracking_error(const geometry::Pose2& map_from_vehicle, double wheelbase_m,
                             const geometry::Pose2& path_pose_at_front) {
  const Eigen::Vector2d front_in_map = map_from_vehicle * Eigen::Vector2d(wheelbase_m, 0.0);
  const Eigen::Vector2d front_in_path = path_pose_at_front.inverse() * front_in_map;
  return {.cross_track_m = -front_in_path.y(),
          .heading_rad =
              geometry::wrap_angle(path_pose_at_front.heading_rad - map_from_vehicle.heading_rad)};
}

double stanley_steering_rad(const TrackingError& error, double speed_mps,
                            const geometry::VehicleShape& vehicle) {
  const double correction_rad =
      std::atan(cross_track_gain(speed_mps) * error.cross_track_m / look_forward_m(speed_mps));
  return limited(error.heading_rad + correction_rad, vehicle);
}

double original_stanley_steering_rad(const TrackingError& error, double speed_mps,
                                     double gain_per_s, const geometry::VehicleShape& vehicle) {
  const double correction_rad = std::atan2(gain_per_s * error.cross_track_m, speed_mps);
  return limited(error.heading_rad + correction_rad, vehicle);
}

double pure_pursuit_steering_rad(const geometry::Pose2& map_from_vehicle, const SampledPath& path,
                                 double rear_s_m, double ahead_m,
                                 const geometry::VehicleShape& vehicle) {
  const Eigen::Vector2d target =
      map_from_vehicle.inverse() * path.at(rear_s_m + ahead_m).position();
  const double squared_m2 = std::max(1e-6, target.squaredNorm());
  return limited(std::atan(2.0 * vehicle.wheelbase_m * target.y() / squared_m2), vehicle);
}

double pursuit_distance_m(double speed_mps) { return std::max(4.0, 0.5 * speed_mps); }

}  // namespace roadbed::control
