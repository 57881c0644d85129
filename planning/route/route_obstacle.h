#pragma once

#include <memory>
#include <string>
#include <vector>

#include "roadbed/planning/route/route.h"
#include "roadbed/planning/route/route_solver.h"

namespace roadbed::planning::inline route {

/// Looks for what keeps a start from a goal that no way leads between: searches from both sides,
/// then with rules left out until a least set of them is known without which there is a way. Some
/// ten searches; what they need of the map is made once. For one thread.
class ObstacleFinder {
 public:
  /// Searches with all rules as the other solver does, but with memory of its own.
  ObstacleFinder(const map::RoadMap& road_map, const RouteSolver& solver);
  ~ObstacleFinder();
  ObstacleFinder(ObstacleFinder&&) noexcept;

  RouteObstacle find(const RoutePlace& from, const RoutePlace& to);

 private:
  struct Solvers;
  std::unique_ptr<Solvers> solvers_;
};

/// The same as one line for the user.
std::string describe(const map::RoadMap& road_map, const map::LanePlace& from,
                     const map::LanePlace& to, const RouteObstacle& obstacle);

}  // namespace roadbed::planning::route
