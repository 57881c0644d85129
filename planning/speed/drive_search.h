#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/geometry/motion/longitudinal.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/planning/speed/st_graph.h"
#include "roadbed/planning/speed/timed_goal.h"

namespace roadbed::planning::inline speed {

/// A drive that is searched for in place, heading, speed and time at once.
struct DriveSearchQuestion {
  const geometry::VehicleShape& vehicle;
  const map::RoadMap& road_map;
  const TrafficBodies& bodies;  ///< from now on
  const TimedGoal& goal;
  VehicleState start;
  double now_s = 0.0;
};

struct DriveSearchOptions {
  double max_lateral_acceleration_mps2 = 3.7;
  double steering_rate_fraction = 0.65;  ///< of the vehicle's
  double actuator_lag_s = geometry::kLongitudinal.actuator_lag_s;
  double clearance_m = 0.12;          ///< to obstacles
  double border_margin_m = 0.08;      ///< to the edge of the road
  double longest_s = 5.4;             ///< a goal that is later is not searched for
  std::size_t kept_states = 200;      ///< at the end of each layer of 0.3 s
  std::size_t most_looked_at = 4000;  ///< per layer, for those
};

/// States of the rear axle every 0.1 s from the start on, up to where the goal is met; empty: none
/// was found, which proves nothing.
///
/// For where no path beside a line and no speed on it is any good: one that swings out, in and out,
/// or ends with a heading. In layers of 0.3 s every state is led on by 25 pairs of a lateral
/// acceleration and a command to the actuator, as the vehicle can steer and its lag makes of it. Of
/// states that are alike one is kept, of those some that are nearest to the goal and some by
/// chance, the same each time, whose body stays on the road's surface and clear of everybody. No
/// rule of the road counts but these.
std::vector<VehicleState> search_drive(const DriveSearchQuestion& question,
                                       const DriveSearchOptions& options = {});

}  // namespace roadbed::planning::speed
