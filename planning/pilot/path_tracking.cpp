#include "roadbed/planning/pilot/path_tracking.h"

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline pilot {

double most_steering_rad(double speed_mps, const geometry::VehicleShape& vehicle,
                         double lateral_mps2) {
  const double squared = std::max(1e-3, speed_mps * speed_mps);
  return std::min(vehicle.max_steering_rad,
                  std::atan(vehicle.wheelbase_m * lateral_mps2 / squared));
}

control::TrackingError tracking_error(const PlannedPath& path,
                                      const geometry::Pose2& map_from_vehicle, double wheelbase_m,
                                      double& front_s_m) {
  const Eigen::Vector2d front = map_from_vehicle * Eigen::Vector2d(wheelbase_m, 0.0);
  front_s_m = path.nearest_front_s_m(front, wheelbase_m, front_s_m);
  return control::tracking_error(map_from_vehicle, wheelbase_m,
                                 path.front_pose_at(front_s_m, wheelbase_m));
}

double tracking_steering_rad(const control::TrackingError& error, double speed_mps,
                             const geometry::VehicleShape& vehicle, double lateral_mps2) {
  const double most = most_steering_rad(speed_mps, vehicle, lateral_mps2);
  return std::clamp(control::stanley_steering_rad(error, speed_mps, vehicle), -most, most);
}

}  // namespace roadbed::planning::pilot
