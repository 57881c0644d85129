#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "roadbed/planning/graph_search.h"
#include "roadbed/planning/route_ends.h"

namespace roadbed::planning {

/// A cheapest way as the passages that it drives through.
struct Way {
  std::vector<Passage> passages;
  Ticks cost = 0;
};

/// A pair of places, ready for a search between them.
struct RouteTask {
  RouteEnd start, goal;
  std::optional<DirectWay> direct;
};

/// A network, its graph and one pricing of it, ready for many questions. For one thread.
class RouteSolver {
 public:
  RouteSolver(std::shared_ptr<const RouteNetwork> network, const RouteOptions& options,
              Leniency leniency = {});
  /// The same graph at other prices.
  RouteSolver(const RouteSolver& other, const RouteOptions& options, Leniency leniency = {});
  RouteSolver(RouteSolver&&) = delete;

  const RouteNetwork& network() const { return *network_; }
  const RouteGraph& graph() const { return *graph_; }
  const TravelRules& rules() const { return rules_; }
  const std::vector<Ticks>& weights() const { return weights_; }
  const Guide& guide() const { return guide_; }
  const RouteOptions& options() const { return options_; }

  std::optional<Way> solve(const map::LanePlace& from, const map::LanePlace& to);

  /// The same with other weights, none of them less than the solver's own. The cost is by them.
  std::optional<Way> solve_with(std::span<const Ticks> weights, const map::LanePlace& from,
                                const map::LanePlace& to);

  /// The same in two steps, for searches that are not the solver's own: between them comes a path
  /// from the task's first seeds to its last.
  RouteTask task(const map::LanePlace& from, const map::LanePlace& to) const;
  std::optional<Way> answer(RouteTask task, const GraphPath& path) const;

  /// Nodes that can be reached from a place at no more than that cost, cheapest first.
  std::vector<Settled> nodes_within(const map::LanePlace& from, Ticks limit);

  /// Lanes that can be reached from a place, or from which it can be; in order, with its own.
  std::vector<std::uint32_t> lanes_from(const map::LanePlace& place);
  std::vector<std::uint32_t> lanes_to(const map::LanePlace& place);

 private:
  Way way_along(const RouteEnd& start, const RouteEnd& goal, const GraphPath& path) const;
  std::vector<std::uint32_t> lanes_of(const RouteEnd& end, std::uint32_t own, bool backward);

  RouteOptions options_;
  std::shared_ptr<const RouteNetwork> network_;
  std::shared_ptr<const RouteGraph> graph_;
  TravelRules rules_;
  std::vector<Ticks> weights_;
  Guide guide_;
  GraphSearch search_;
};

}  // namespace roadbed::planning
