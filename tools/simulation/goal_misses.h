#pragma once

#include <string>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/planning/speed/timed_goal.h"

namespace roadbed::tools::inline simulation {

/// What a drive lacked of its goal, at the time steps at which it could have been reached.
class GoalMisses {
 public:
  /// @param t_s  one of the scenario's time steps
  void look(const planning::TimedGoal& goal, const map::RoadMap& road_map, double t_s,
            const planning::VehicleState& truth, const geometry::VehicleShape& vehicle);

  /// "at best only its heading was missed, after 4.20 s"; empty if it was never time for it.
  std::string at_best() const;

 private:
  std::size_t fewest_ = 4;
  std::string what_;
  double at_s_ = 0.0;
};

}  // namespace roadbed::tools::simulation
