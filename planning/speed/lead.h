#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/longitudinal.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline speed {

/// The first obstacle that the vehicle would touch if it drove on along its path and everything
/// else stood still.
struct Lead {
  std::size_t obstacle = 0;        ///< index
  double gap_m = 0.0;              ///< that the vehicle can still drive, along the reference line
  double speed_mps = 0.0;          ///< of the obstacle along the path; negative if it comes nearer
  double acceleration_mps2 = 0.0;  ///< of the same, over the last 0.3 s
};

/// For reasons: who it is, how far ahead and how fast, with a decimal each; one that stands does so
/// at 0.0 m/s, whichever way it is measured to creep.
std::string lead_text(const std::string& name, double gap_m, double speed_mps);

/// @param s_m            station of the rear axle.
/// @param look_ahead_m   no further than this.
/// @param side_margin_m  an obstacle this near to the body's sides counts as touched.
/// @param obstacles      those that are not there at the time are not looked at.
/// @param ignored        nor are these; none if empty.
std::optional<Lead> find_lead(const PlannedPath& path, double s_m, double look_ahead_m,
                              std::span<const Obstacle> obstacles, double t_s,
                              const geometry::VehicleShape& vehicle, double side_margin_m,
                              const std::vector<bool>& ignored = {});

/// Where the vehicle is: station and lateral offset of its rear axle.
struct VehicleOnLine {
  const ReferenceLine& line;
  double s_m, d_m, width_m;
};

/// Whether an obstacle drives behind the vehicle in its lane, and so has to keep its distance: its
/// centre is behind the rear axle, its body behind the vehicle's, and it heads along the line (up
/// to 37 degrees). O(N) in the line's points.
bool is_following(const Obstacle& obstacle, double t_s, const VehicleOnLine& vehicle);

/// Whether an obstacle, as it is foreseen, comes onto the line from beside within 10 s and is
/// behind the vehicle then, which keeps its speed, so that it has to keep its distance as who
/// follows does: who drives on in a roundabout that the vehicle has entered. Braking by 4 m/s² has
/// to do for it. O(N) in the line's points.
bool comes_behind(const Obstacle& obstacle, double t_s, const VehicleOnLine& vehicle,
                  double speed_mps, const geometry::VehicleShape& shape);

/// Whether an obstacle moves across a line (more than 37 degrees from it, either way along).
/// O(N) in the line's points.
bool is_crossing(const Obstacle& obstacle, double t_s, const ReferenceLine& line);

/// Deceleration that the safety layer demands beyond what the cruise control may ask for.
struct SafetyOptions {
  /// Up to here the cruise control brakes itself.
  double cruise_limit_mps2 = geometry::kLongitudinal.max_command_mps2;
  double most_mps2 = geometry::kLongitudinal.max_braking_mps2;  ///< the vehicle's limit
  double standoff_m = 1.0;                                      ///< gap to come to rest at
  /// The actuator's lag, driven before it bites.
  double reaction_s = geometry::kLongitudinal.actuator_lag_s;
  double lead_brakes_mps2 = 2.0;  ///< more than that: it is taken to brake on until it stands
};

/// Deceleration [m/s²] that stops the closing in time, if the cruise control's authority cannot:
/// c² / (2 (gap − standoff − c · reaction)), c the closing speed; behind a lead that brakes, the
/// one that stops the vehicle where that will stand, if it is more. None: no need.
std::optional<double> emergency_deceleration_mps2(double speed_mps, const Lead& lead,
                                                  const SafetyOptions& options = {});

/// Deceleration that stops within a distance: v² / 2 d, at most the vehicle's limit. None: it
/// stands.
std::optional<double> emergency_stop_mps2(double speed_mps, double distance_m,
                                          const SafetyOptions& options = {});

}  // namespace roadbed::planning::speed
