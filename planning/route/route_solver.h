#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "roadbed/planning/route/graph_search.h"
#include "roadbed/planning/route/hierarchy_search.h"
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

/// A cheapest way as the lane groups that it drives through.
struct Way {
  std::vector<LaneGroup> lane_groups;
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
              RelaxedRules relaxed = {});
  /// The same graph at other prices.
  RouteSolver(const RouteSolver& other, const RouteOptions& options, RelaxedRules relaxed = {});
  RouteSolver(RouteSolver&&) = delete;

  const RouteNetwork& network() const { return *network_; }
  const RouteGraph& graph() const { return *graph_; }
  const RoutingCostModel& model() const { return model_; }
  const std::vector<Ticks>& weights() const { return weights_; }
  const Guide& guide() const { return guide_; }
  const RouteOptions& options() const { return options_; }

  /// Builds a hierarchy, by which solve() then searches: for many questions. Of ways that cost the
  /// same it may take another one than A*.
  void prepare();
  bool is_prepared() const { return tree_ != nullptr; }

  /// For searches of other threads. @pre is_prepared()
  const HierarchyMetric& metric() const { return tree_->metric; }

  std::optional<Way> solve(const RoutePlace& from, const RoutePlace& to);

  /// The same with other weights, none of them less than the solver's own. The cost is by them.
  std::optional<Way> solve_with(std::span<const Ticks> weights, const RoutePlace& from,
                                const RoutePlace& to);

  /// The same in two steps, for searches that are not the solver's own: between them comes a path
  /// from the task's first seeds to its last.
  RouteTask task(const RoutePlace& from, const RoutePlace& to) const;
  std::optional<Way> answer(RouteTask task, const GraphPath& path) const;

  /// Nodes that can be reached from a place at no more than that cost, cheapest first.
  std::vector<Settled> nodes_within(const RoutePlace& from, Ticks limit);

  /// Lanes of the network that can be reached from a place, or from which it can be; in order, with
  /// its own.
  std::vector<std::uint32_t> lanes_from(const RoutePlace& place);
  std::vector<std::uint32_t> lanes_to(const RoutePlace& place);

 private:
  Way way_along(const RouteEnd& start, const RouteEnd& goal, const GraphPath& path) const;
  std::vector<LaneGroup> lane_groups_of_change(std::uint32_t from, std::uint32_t arc) const;
  std::vector<std::uint32_t> lanes_of(const RouteEnd& end, const RoutePlace& own, bool backward);

  RouteOptions options_;
  std::shared_ptr<const RouteNetwork> network_;
  std::shared_ptr<const RouteGraph> graph_;
  RoutingCostModel model_;
  std::vector<Ticks> weights_;
  Guide guide_;
  GraphSearch search_;
  struct Tree {
    Tree(const RouteGraph& graph, const Guide& guide, std::span<const Ticks> weights);
    Hierarchy hierarchy;
    HierarchyMetric metric;
    HierarchySearch search;
  };
  std::unique_ptr<Tree> tree_;
};

}  // namespace roadbed::planning::route
