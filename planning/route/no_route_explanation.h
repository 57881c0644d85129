#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/route_place.h"

namespace roadbed::planning::inline route {

class RouteSolver;

/// What keeps a route from being found.
enum class BlockingRule { closed, length, marking, participant, one_way, map_gap };
std::string_view to_string(BlockingRule rule);

/// What stands between a start and a goal that no route connects.
struct NoRouteExplanation {
  std::size_t lanes_from_start = 0;  ///< that can be reached
  std::size_t lanes_to_goal = 0;     ///< from which the goal can be reached
  double gap_m = 0.0;                ///< least distance from an end of those to a start of these
  std::optional<map::LaneId> gap_from, gap_to;
  /// A least set of rules without which there would be a route; just `map_gap` if there is none
  /// even without all of them.
  std::vector<BlockingRule> blocking_rules;
  /// Where the route that would be there then leaves the lanes that can be reached.
  std::optional<map::LaneId> blocked_from, blocked_to;
};

/// Looks for what keeps a start from a goal that no way leads between: searches from both sides,
/// then with rules left out until a least set of them is known without which there is a way. Some
/// ten searches; what they need of the map is made once. For one thread.
class NoRouteExplainer {
 public:
  /// Searches with all rules as the other solver does, but with memory of its own.
  NoRouteExplainer(const map::RoadMap& road_map, const RouteSolver& solver);
  ~NoRouteExplainer();
  NoRouteExplainer(NoRouteExplainer&&) noexcept;
  /// @pre no way leads from one place to the other.
  NoRouteExplanation find(const RoutePlace& from, const RoutePlace& to);

 private:
  struct Solvers;
  std::unique_ptr<Solvers> solvers_;
};

/// The same as one line for the user.
std::string describe(const map::RoadMap& road_map, const map::LanePlace& from,
                     const map::LanePlace& to, const NoRouteExplanation& explanation);

}  // namespace roadbed::planning::route
