#include "roadbed/control/stanley.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::control {

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
  return std::clamp(error.heading_rad + correction_rad, -vehicle.max_steering_rad,
                    vehicle.max_steering_rad);
}

}  // namespace roadbed::control
