#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "roadbed/map/lanelet2/write/lanelet_map.h"

namespace roadbed::map::lanelet2 {

/// Lanelets by the regulatory elements that they name, as places in OsmMap::relations.
std::map<std::uint32_t, std::vector<LaneId>> users_of_regulations(const LaneletMap& made);

/// Lets a lanelet name a regulatory element, once.
void name_regulation(LaneletMap& made, LaneId lane, std::uint32_t regulation);
void forget_regulation(LaneletMap& made, LaneId lane, std::uint32_t regulation);

/// Where a lanelet begins or ends, from its left to its right border, in map [m].
struct LaneletEdge {
  Eigen::Vector3d left{0, 0, 0}, right{0, 0, 0};
};
LaneletEdge start_edge(const LaneletMap& made, LaneId lane);
LaneletEdge end_edge(const LaneletMap& made, LaneId lane);

/// A stop line across lanelets that lie beside each other, by their edges: from the leftmost to the
/// rightmost corner of those that run as the first one does, and are within 30 m of it.
std::uint32_t add_stop_line(LaneletMap& made, const std::vector<LaneletEdge>& edges);

}  // namespace roadbed::map::lanelet2
