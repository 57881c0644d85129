#pragma once

#include "roadbed/control/sampled_path.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::control {

/// How the front axle's centre lies to the path, the one sign convention of lateral control:
///
///            path ──────▶          e_fa > 0: the path is to the left of the front axle
///                   │ e_fa > 0     θ_e  > 0: the path points further to the left than the vehicle
///              ▭────o ▶            δ    > 0: the wheels point to the left
///
/// so that every positive error asks for a positive steering angle.
struct TrackingError {
  double cross_track_m = 0.0;  ///< e_fa, along the normal of the path
  double heading_rad = 0.0;    ///< θ_e: path heading minus vehicle heading, in (−π, π]
};

/// Look-forward distance L_x(v) of paper eq. 33 [m]: 10, then 0.8 v, then 20.
double look_forward_m(double speed_mps);

/// Gain k_e(v) of paper eq. 34 and Fig. 13: min(1, 0.5 + 0.02 v), from v = 0 (eq. 34 leaves speeds
/// below 12.5 m/s out; Fig. 13 shows them).
double cross_track_gain(double speed_mps);

/// Errors of a vehicle against the pose of the path nearest to its front axle.
TrackingError tracking_error(const geometry::Pose2& map_from_vehicle, double wheelbase_m,
                             const geometry::Pose2& path_pose_at_front);

/// Modified Stanley law, paper eq. 32: δ = θ_e + atan(k_e e_fa / L_x), limited to ±max_steering.
double stanley_steering_rad(const TrackingError& error, double speed_mps,
                            const geometry::VehicleShape& vehicle);

// What the modified Stanley law is compared with.

/// Original Stanley law (paper eq. 31): δ = θ_e + atan(k e_fa / v), limited to ±max_steering;
/// at standstill the second term is ±π/2, or 0 on the path.
double original_stanley_steering_rad(const TrackingError& error, double speed_mps,
                                     double gain_per_s, const geometry::VehicleShape& vehicle);

/// Pure pursuit: the circle through the rear axle, tangent to the vehicle, that meets the path at
/// its target, δ = atan(2 L sin α / l) [Coulter 1992, CMU-RI-TR-92-01]. The target lies `ahead_m`
/// beyond the path's place nearest to the rear axle, `rear_s_m`.
double pure_pursuit_steering_rad(const geometry::Pose2& map_from_vehicle, const SampledPath& path,
                                 double rear_s_m, double ahead_m,
                                 const geometry::VehicleShape& vehicle);

/// The target's distance: half a second of driving, at least 4 m.
double pursuit_distance_m(double speed_mps);

}  // namespace roadbed::control
