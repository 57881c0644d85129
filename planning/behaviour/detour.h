#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/planning/behaviour/route_line.h"
#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/planning/route/route_options.h"
#include "roadbed/planning/task/driving_task.h"

namespace roadbed::planning::inline behaviour {

/// Another way to the goal of a task, from where the vehicle stands.
struct Detour {
  Route route;
  RouteLine line;
  std::vector<StopPoint> stop_points;
  std::vector<std::size_t> blockers;      ///< obstacles that it avoids
  std::vector<map::LaneId> missed;        ///< lanes that it avoids
  map::LaneId by_lane;                    ///< its first that the blocked route does not use
  double longer_s = 0.0, longer_m = 0.0;  ///< than the way that is given up, by the route's costs

  /// Leads a task's vehicle along it.
  void lead(DrivingTask& of) const;
};

/// A way round, or why there is none.
struct DetourAnswer {
  std::optional<Detour> detour;
  std::string reason;  ///< one line; empty if there is one
};

struct DetourQuestion {
  const DrivingTask& task;
  const geometry::VehicleShape& vehicle;
  const DrivingOptions& driving;
  const VehicleState& measured;
  double t_s;
  std::vector<std::size_t> blockers;     ///< obstacles that stand for ever
  std::vector<map::LaneId> missed = {};  ///< lanes that cannot be come to
};

/// Whether an obstacle is there and does not move, now.
bool is_standing(const Obstacle& obstacle, double t_s);

/// Stretches of the map's lanes that an obstacle closes, for the rear axle of a vehicle: where it
/// leaves less room within the lane than the vehicle and its clearance to both sides take. On the
/// lanes of the route it is in the way wherever it is.
std::vector<BlockedStretch> stretches_closed_by(const Obstacle& obstacle,
                                                const DetourQuestion& question);

/// What is said of a way that is taken: by which lane, and how much longer it is.
std::string described(const Detour& detour, const map::RoadMap& road_map);

/// Obstacles that ways of a task are known to be blocked by, still.
std::vector<std::size_t> known_blockers(const DrivingTask& task, double t_s);

/// The cheapest route to the task's goal that passes none of the blockers and that the vehicle can
/// join by driving on: from any lane that it stands on and along (lanes that part overlap at
/// first), left before the blocker by a lane change or at the lane's end, and with a path that
/// leads onto it past all who stand; of the first eight. A route search for each of those lanes and
/// routes, on networks made now.
/// @pre the task has a route
DetourAnswer find_detour(const DetourQuestion& question);

}  // namespace roadbed::planning::behaviour
