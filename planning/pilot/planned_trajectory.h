#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/behaviour/planner_types.h"
#include "roadbed/planning/lateral/planned_path.h"

namespace roadbed::planning::inline pilot {

/// Where a vehicle drives along, from which station on, and where it has to have stopped.
struct WayToDrive {
  const PlannedPath& path;
  double from_s_m;
  double to_s_m = std::numeric_limits<double>::infinity();
};

/// The trajectory of a decision: along the path at the speeds that are foreseen, a row every 0.1 s,
/// then to a stop, so that it may be driven to its end where nothing comes after it: from where 3
/// m/s² lead to a stop in time, or as hard as it takes. A decision to brake harder than the drive
/// foresees brakes on to a stop at once, harder where bends on the way would ask for more than 3
/// m/s² to the side.
/// @param t_s  of the first row.
geometry::Trajectory planned_trajectory(const WayToDrive& way, double t_s,
                                        const VehicleState& measured,
                                        const PlannerCommand& decision,
                                        const geometry::VehicleShape& vehicle);

/// No trajectory of a decision leads farther than this, wherever it has to have stopped.
double farthest_m(const PlannerCommand& decision);

/// Straight on from where the vehicle is, to a stop at 3 m/s².
geometry::Trajectory stopping_trajectory(double t_s, const VehicleState& measured);

/// Deceleration after a drive, to come to rest behind the lead should it brake by 8 m/s² from then
/// on; 3 m/s² at least, 8 m/s² at most.
double braking_after_mps2(const std::vector<SpeedState>& drive,
                          const std::optional<DriveLead>& lead);

}  // namespace roadbed::planning::pilot
