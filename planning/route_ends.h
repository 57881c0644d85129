#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/planning/graph_search.h"
#include "roadbed/planning/travel_rules.h"

namespace roadbed::planning {

/// The lanes that one passage uses, in turn, the part of it that is driven, and its changes.
struct Passage {
  std::vector<std::uint32_t> chain;
  ShareRange range;
  ChangePlan changes;
};

/// The ways between a place in a passage and the nodes at which the graph begins or ends for it:
/// seeds for a search, and the passage that each of them stands for.
struct RouteEnd {
  std::vector<Seed> seeds;
  std::vector<Passage> passages;
};

/// From a place to the entries of the passages behind its own.
RouteEnd leave_from(const RouteGraph& graph, const TravelRules& rules, const map::LanePlace& place);

/// From the entry of its passage to a place.
RouteEnd arrive_at(const RouteGraph& graph, const TravelRules& rules, const map::LanePlace& place);

/// A way within one passage.
struct DirectWay {
  Passage passage;
  Ticks cost = 0;
};
std::optional<DirectWay> direct_way(const TravelRules& rules, const map::LanePlace& from,
                                    const map::LanePlace& to);

}  // namespace roadbed::planning
