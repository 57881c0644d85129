#pragma once

#include "roadbed/control/stanley.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/behaviour/planner_types.h"
#include "roadbed/planning/lateral/planned_path.h"

namespace roadbed::planning::inline pilot {

/// Steering angle that keeps v² tan(δ)/L within a lateral acceleration.
double most_steering_rad(double speed_mps, const geometry::VehicleShape& vehicle,
                         double lateral_mps2 = kUsualLateral_mps2);

/// Of the front axle, against the path that it draws while the rear axle follows the plan.
/// @param front_s_m  station of the front axle's nearest place: searched near the one given, and
///                   set.
control::TrackingError tracking_error(const PlannedPath& path,
                                      const geometry::Pose2& map_from_vehicle, double wheelbase_m,
                                      double& front_s_m);

/// The modified Stanley law (paper eq. 32) within a lateral acceleration.
double tracking_steering_rad(const control::TrackingError& error, double speed_mps,
                             const geometry::VehicleShape& vehicle,
                             double lateral_mps2 = kUsualLateral_mps2);

}  // namespace roadbed::planning::pilot
