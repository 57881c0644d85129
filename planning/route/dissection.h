#pragma once

#include <cstdint>
#include <vector>

#include "roadbed/planning/route/graph_search.h"

namespace roadbed::planning::inline route {

/// An order of the nodes in which few arcs have to be added when they are taken out one after the
/// other: nested dissection by straight lines.
///
/// Each part of the graph is cut across, in one of four directions and within the middle half of
/// its nodes, at the place where fewest nodes of one side touch the other one. The least set of
/// nodes that touches all arcs of the cut (König's theorem) comes last, the two sides before it in
/// the same way. O(N log² N).
/// @returns  nodes, first to last.
std::vector<std::uint32_t> dissection_order(const RouteGraph& graph,
                                            const std::vector<Eigen::Vector2d>& place_in_map);

}  // namespace roadbed::planning::route
