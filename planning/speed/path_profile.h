#pragma once

#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/planning/reference/speed_ceiling.h"

namespace roadbed::planning::inline speed {

/// Speeds that a bend allows.
struct BendLimits {
  double max_lateral_acceleration_mps2 = 3.2;
  double steering_rate_fraction = 0.85;  ///< of the vehicle's
};

/// The path ahead, sampled: what longitudinal planning needs to know of it. All lists
/// have one entry per sample.
struct PathProfile {
  std::vector<double> ahead_m;    ///< driven since the first sample, by the rear axle; ascends
  std::vector<double> station_m;  ///< of the reference line
  std::vector<geometry::Rectangle> body;
  std::vector<double> curvature_per_m;
  std::vector<double> wanted_mps;  ///< by the ceiling of the line
  std::vector<double> most_mps;    ///< that the path's own bends allow

  double length_m() const { return ahead_m.back(); }

  /// Index of the last sample that is not further ahead.
  std::size_t before(double distance_m) const;

  /// Way from the first sample to a station of the line; less than 0 before it.
  double ahead_of_m(double s_m) const;
};

/// Samples a path from a station on over `length_m` of its reference line, every 0.5 m, beyond 40 m
/// every metre.
PathProfile sample_path_profile(const PlannedPath& path, double from_s_m, double length_m,
                                const SpeedCeiling& ceiling, const geometry::VehicleShape& vehicle,
                                const BendLimits& limits = {});

/// Sets anew how fast the path's bends may be taken.
void limit_speed_in_bends(PathProfile& profile, const geometry::VehicleShape& vehicle,
                          const BendLimits& limits);

/// Distances after 0, 0.1, 0.2 … s of driving on freely to what the line's ceiling wants, until
/// `until_m` is passed; for 15 s at most.
/// @param speeds_up_mps2  1 m/s² is what the cruise control comes to while it sets off.
std::vector<double> drive_on(const PathProfile& profile, double speed_mps, double until_m,
                             double speeds_up_mps2 = 1.0);

/// How far along the path every corner of the body stays on the road surface [m]: up to the sample
/// before the first that does not, and infinite if there is none. Where the path begins off the
/// road only what comes after it has returned counts.
double on_road_m(const PathProfile& profile, const map::RoadMap& road_map);

}  // namespace roadbed::planning::speed
