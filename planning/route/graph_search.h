#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roadbed/planning/route/route_graph.h"

namespace roadbed::planning::inline route {

/// Where a search begins or ends, and what the way before or behind it costs.
struct Seed {
  std::uint32_t node = 0;
  Ticks cost = 0;
};

/// A cheapest way from one of the first seeds to one of the last.
struct GraphPath {
  Ticks cost = kNever;  ///< with both seeds'; kNever: there is none
  std::size_t from_seed = 0, to_seed = 0;
  std::vector<std::uint32_t> arcs;
};

/// A node that a search has settled.
struct Settled {
  std::uint32_t node = 0;
  Ticks cost = 0;
};

/// Straight lines as a lower bound of costs: of each node's place and the least cost per metre of
/// any arc between the places of its nodes.
struct Guide {
  std::vector<Eigen::Vector2d> place_in_map;  ///< one per node
  double ticks_per_m = 0.0;
};

Guide make_guide(const RouteGraph& graph, const RouteNetwork& network,
                 std::span<const Ticks> weights);

/// Searches of a graph. Keeps its working memory from one to the next; for one thread.
class GraphSearch {
 public:
  explicit GraphSearch(const RouteGraph& graph);

  /// A*: h(n) = r · max(0, |n − g| − R), with all goals within R of g. Of ways that cost the same
  /// the one whose nodes come first is taken.
  GraphPath find(std::span<const Ticks> weights, const Guide& guide, std::span<const Seed> from,
                 std::span<const Seed> to);

  /// Everything that can be reached at no more than `limit`, cheapest first (Dijkstra).
  /// @param backward  what leads to the seeds instead.
  std::vector<Settled> reach(std::span<const Ticks> weights, std::span<const Seed> from,
                             Ticks limit, bool backward = false);

 private:
  struct State {
    Ticks cost = kNever;
    std::uint32_t parent = 0;
    std::uint32_t round = 0;  ///< of the search that wrote it
    Ticks ahead = 0;          ///< lower bound of the way to the goal
  };
  static constexpr std::uint32_t kSeedBit = 1U << 31;

  State& state(std::uint32_t node);
  void begin();
  void improve(std::uint32_t node, Ticks cost, std::uint32_t parent);
  GraphPath trace(std::uint32_t node) const;

  const RouteGraph& graph_;
  std::vector<State> states_;
  std::vector<std::uint64_t> heap_;  ///< estimate above node, so that ties are settled by node
  std::vector<std::uint32_t> goal_of_;
  std::uint32_t round_ = 0;
  const Guide* guide_ = nullptr;
  Eigen::Vector2d goal_in_map_{0, 0};
  double goal_radius_m_ = 0.0;
};

}  // namespace roadbed::planning::route
