#pragma once

#include <optional>
#include <vector>

#include "roadbed/map/road_map.h"
#include "roadbed/planning/travel_rules.h"

namespace roadbed::planning {

/// The lanes that one passage uses, in turn, and its share of them.
struct Passage {
  std::vector<map::LaneId> lanes;
  double from = 0.0, to = 1.0;  ///< fractions of each lane's length
};

struct SearchResult {
  std::optional<std::vector<Passage>> passages;
  std::vector<map::LaneId> reached;  ///< lanes that were settled, in order of id
};

/// Cheapest way by A*; see find_route().
SearchResult search(const TravelRules& rules, const map::LanePlace& from, const map::LanePlace& to);

}  // namespace roadbed::planning
