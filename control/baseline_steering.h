#pragma once

#include "roadbed/control/course.h"
#include "roadbed/control/stanley.h"

namespace roadbed::control {

// What the modified Stanley law is compared with.

/// Original Stanley law (paper eq. 31): δ = θ_e + atan(k e_fa / v), limited to ±max_steering;
/// at standstill the second term is ±π/2, or 0 on the path.
double original_stanley_steering_rad(const TrackingError& error, double speed_mps,
                                     double gain_per_s, const geometry::VehicleShape& vehicle);

/// Pure pursuit: the circle through the rear axle, tangent to the vehicle, that meets the course at
/// its target, δ = atan(2 L sin α / l) [Coulter 1992, CMU-RI-TR-92-01]. The target lies `ahead_m`
/// beyond the course's place nearest to the rear axle, `rear_s_m`.
double pure_pursuit_steering_rad(const geometry::Pose2& map_from_vehicle, const Course& course,
                                 double rear_s_m, double ahead_m,
                                 const geometry::VehicleShape& vehicle);

/// The target's distance: half a second of driving, at least 4 m.
double pursuit_distance_m(double speed_mps);

}  // namespace roadbed::control
