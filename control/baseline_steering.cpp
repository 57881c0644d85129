#include "roadbed/control/baseline_steering.h"

#include <algorithm>
#include <cmath>

namespace roadbed::control {
namespace {

double limited(double steering_rad, const geometry::VehicleShape& vehicle) {
  return std::clamp(steering_rad, -vehicle.max_steering_rad, vehicle.max_steering_rad);
}

}  // namespace

double original_stanley_steering_rad(const TrackingError& error, double speed_mps,
                                     double gain_per_s, const geometry::VehicleShape& vehicle) {
  const double correction_rad = std::atan2(gain_per_s * error.cross_track_m, speed_mps);
  return limited(error.heading_rad + correction_rad, vehicle);
}

double pure_pursuit_steering_rad(const geometry::Pose2& map_from_vehicle, const Course& course,
                                 double rear_s_m, double ahead_m,
                                 const geometry::VehicleShape& vehicle) {
  const Eigen::Vector2d target =
      map_from_vehicle.inverse() * course.at(rear_s_m + ahead_m).position();
  const double squared_m2 = std::max(1e-6, target.squaredNorm());
  return limited(std::atan(2.0 * vehicle.wheelbase_m * target.y() / squared_m2), vehicle);
}

double pursuit_distance_m(double speed_mps) { return std::max(4.0, 0.5 * speed_mps); }

}  // namespace roadbed::control
