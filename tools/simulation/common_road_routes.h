#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/route.h"
#include "roadbed/planning/speed/timed_goal.h"

namespace roadbed::tools::inline simulation {

/// A planning problem of a CommonRoad file, and what is said about it in errors.
struct ProblemSource {
  std::string file;
  const map::RoadMap& road_map;
  const map::commonroad::PlanningProblem& problem;
  double step_s;

  /// @throws InputError
  [[noreturn]] void refuse(const std::string& found, const std::string& needed,
                           const std::string& remedy) const;
};

/// Routes to the goal of a planning problem: the one to drive, and others that lead to it, too.
struct ProblemRoutes {
  planning::Route best;
  /// From all lanes that the start may be on, or that may be changed to there, to each lane under
  /// the goal; the cheapest first, each over other lanes, at most four.
  std::vector<planning::Route> others;
};

/// @param start  rear axle
/// @throws InputError if the start is off the road or no route leads to the goal.
ProblemRoutes routes_of(const ProblemSource& source, const geometry::Pose2& start, double speed_mps,
                        const geometry::VehicleShape& vehicle, const planning::TimedGoal& goal);

}  // namespace roadbed::tools::simulation
