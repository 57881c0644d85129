#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/behaviour/planned_path.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline behaviour {

/// The first obstacle that the vehicle would touch if it drove on along its path and everything
/// else stood still.
struct Lead {
  std::size_t obstacle = 0;        ///< index
  double gap_m = 0.0;              ///< that the vehicle can still drive, along the reference line
  double speed_mps = 0.0;          ///< of the obstacle along the path; negative if it comes nearer
  double acceleration_mps2 = 0.0;  ///< of the same, over the last 0.3 s
};

/// @param s_m            station of the rear axle.
/// @param look_ahead_m   no further than this.
/// @param side_margin_m  an obstacle this near to the body's sides counts as touched.
/// @param ignored        obstacles that are not looked at; none if empty.
std::optional<Lead> find_lead(const PlannedPath& path, double s_m, double look_ahead_m,
                              const std::vector<Obstacle>& obstacles, double t_s,
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

}  // namespace roadbed::planning::behaviour
