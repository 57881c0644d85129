#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
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

/// Consecutive ranks, and where the arcs between them and one rank stand.
struct RankRun {
  std::uint32_t first = 0;  ///< rank
  std::uint32_t count = 0;
  std::uint32_t first_arc = 0;  ///< place of the first one; the others follow

  std::uint32_t end() const { return first + count; }
};

/// A contraction hierarchy that depends on the shape of a graph only, not on its weights:
/// customisable contraction hierarchies [Dibbelt, Strasser, Wagner 2014, arXiv:1402.0402].
///
/// Nodes are taken out in the order of their rank; those above that are left behind are joined to
/// each other. Every cheapest way then has one of equal cost that climbs in rank first and goes
/// down after. What a node leads up to is stored as runs of ranks, since separators are: a search
/// is a few passes over plain arrays. Arcs are numbered by their lower rank; by their higher one
/// each has a second place, so that those that lead up to a rank stand together, too.
struct Hierarchy {
  std::vector<std::uint32_t> node_of_rank, rank_of_node;
  std::vector<std::uint32_t> parent;  ///< lowest rank above, its own for a root
  CsrLists<RankRun> above;            ///< of each rank, ascending; places are arcs
  CsrLists<RankRun> below;            ///< of each rank, ascending; places are second ones
  std::uint32_t arcs = 0;
  std::vector<std::uint32_t> arc_of;  ///< hierarchy's arc of each of the graph

  /// The arc from a rank up to a higher one; kNoNode if there is none. O(log runs).
  std::uint32_t arc_between(std::uint32_t low, std::uint32_t high) const;

  /// Its second place. @pre there is one.
  std::uint32_t place_below(std::uint32_t low, std::uint32_t high) const;
};

/// Visits what two ascending lists of runs share, the last ranks first: with the first rank, their
/// number, and the place of the first arc in either list. Stops at true. O(the shorter list's runs
/// times the logarithm of how many of the other one lie between them).
template <typename Visit>
void for_each_shared(std::span<const RankRun> one, std::span<const RankRun> other,
                     const Visit& visit);

Hierarchy make_hierarchy(const RouteGraph& graph, const std::vector<std::uint32_t>& order);

/// Of the runs up to the last one, which begins at the rank or behind it, those that do not.
inline std::span<const RankRun> runs_before(std::span<const RankRun> runs, std::uint32_t rank) {
  std::size_t step = 1;
  while (step < runs.size() && runs[runs.size() - 1 - step].first >= rank) step *= 2;
  const std::size_t from = runs.size() - std::min(runs.size(), step + 1);
  const auto end =
      std::partition_point(runs.begin() + static_cast<std::ptrdiff_t>(from), runs.end() - 1,
                           [rank](const RankRun& run) { return run.first < rank; });
  return runs.first(static_cast<std::size_t>(end - runs.begin()));
}

template <typename Visit>
void for_each_shared(std::span<const RankRun> one, std::span<const RankRun> other,
                     const Visit& visit) {
  while (!one.empty() && !other.empty()) {
    const RankRun &a = one.back(), &b = other.back();
    if (a.first >= b.end()) {
      one = runs_before(one, b.end());
    } else if (b.first >= a.end()) {
      other = runs_before(other, a.end());
    } else {
      const std::uint32_t first = std::max(a.first, b.first);
      const std::uint32_t count = std::min(a.end(), b.end()) - first;
      if (visit(first, count, a.first_arc + (first - a.first), b.first_arc + (first - b.first))) {
        return;
      }
      std::span<const RankRun>& passed = a.first < b.first ? other : one;
      passed = passed.first(passed.size() - 1);
    }
  }
}

}  // namespace roadbed::planning::route
