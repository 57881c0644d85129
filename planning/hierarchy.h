#pragma once

#include <cstdint>
#include <vector>

#include "roadbed/planning/graph_search.h"

namespace roadbed::planning {

/// Consecutive ranks, and where the arcs to them stand.
struct RankRun {
  std::uint32_t first = 0;  ///< rank
  std::uint32_t count = 0;
  std::uint32_t first_arc = 0;  ///< of the hierarchy; the others follow
};

/// A contraction hierarchy that depends on the shape of a graph only, not on its weights:
/// customisable contraction hierarchies [Dibbelt, Strasser, Wagner 2014, arXiv:1402.0402].
///
/// Nodes are taken out in the order of their rank; those above that are left behind are joined to
/// each other. Every cheapest way then has one of equal cost that climbs in rank first and goes
/// down after. What a node leads up to is stored as runs of ranks, since separators are: a search
/// is a few passes over plain arrays.
struct Hierarchy {
  std::vector<std::uint32_t> node_of_rank, rank_of_node;
  std::vector<std::uint32_t> parent;  ///< lowest rank above, its own for a root
  Grouped<RankRun> above;             ///< of each rank, ascending
  Grouped<std::uint32_t> below;       ///< ranks that lead up to a rank, ascending
  std::uint32_t arcs = 0;
  std::vector<std::uint32_t> arc_of;  ///< hierarchy's arc of each of the graph

  /// The arc from a rank up to a higher one; kNoNode if there is none. O(log runs).
  std::uint32_t arc_between(std::uint32_t low, std::uint32_t high) const;
};

Hierarchy make_hierarchy(const RouteGraph& graph, const std::vector<std::uint32_t>& order);

}  // namespace roadbed::planning
