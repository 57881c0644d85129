#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/planning/route/graph_search.h"
#include "roadbed/planning/route/route_place.h"
#include "roadbed/planning/route/routing_cost_model.h"

namespace roadbed::planning::inline route {

/// The ways between a place in a lane group and the nodes at which the graph begins or ends for it:
/// seeds for a search, and the lane groups that each of them stands for. It is one, or those of a
/// change that takes several.
struct RouteEnd {
  std::vector<Seed> seeds;
  std::vector<std::vector<LaneGroup>> ways;
};

/// From a place to the entries of the lane groups behind its own; where a way is a change over
/// several lane groups, to the exit of its last one, the cost of which is not counted yet.
RouteEnd leave_from(const RouteGraph& graph, const RoutingCostModel& model,
                    const RoutePlace& place);

/// From the entry of its lane group to a place, or from that of the first one of a change that ends
/// there.
RouteEnd arrive_at(const RouteGraph& graph, const RoutingCostModel& model, const RoutePlace& place);

/// A way within one lane group, or over those of one change.
struct DirectWay {
  std::vector<LaneGroup> lane_groups;
  Ticks cost = 0;
};
std::optional<DirectWay> direct_way(const RoutingCostModel& model, const RoutePlace& from,
                                    const RoutePlace& to);

}  // namespace roadbed::planning::route
