#pragma once

#include "roadbed/geometry/pose2.h"
#include "roadbed/geometry/vehicle_shape.h"

namespace roadbed::control {

/// Place on the path nearest to the centre of the front axle.
struct TrackingError {
  double cross_track_m = 0.0;  ///< e_fa: path minus front axle, positive if the path is to the left
  double heading_rad = 0.0;    ///< θ_e: path heading minus vehicle heading, wrapped
};

/// Look-forward distance L_x(v) of paper eq. 33 [m].
double look_forward_m(double speed_mps);

/// Gain k_e(v) of paper eq. 34 and Fig. 13: min(1, 0.5 + 0.02 v).
double cross_track_gain(double speed_mps);

/// Errors of a vehicle against the path's pose nearest to its front axle.
TrackingError tracking_error(const geometry::Pose2& map_from_vehicle, double wheelbase_m,
                             const geometry::Pose2& path_pose_at_front);

/// Modified Stanley law, paper eq. 32: δ = θ_e + atan(k_e e_fa / L_x), limited to ±max_steering.
double stanley_steering_rad(const TrackingError& error, double speed_mps,
                            const geometry::VehicleShape& vehicle);

}  // namespace roadbed::control
