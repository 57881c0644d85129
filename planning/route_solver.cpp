#include "roadbed/planning/route_solver.h"

#include <algorithm>

namespace roadbed::planning {

RouteSolver::RouteSolver(std::shared_ptr<const RouteNetwork> network, const RouteOptions& options,
                         Leniency leniency)
    : options_(options),
      network_(std::move(network)),
      graph_(std::make_shared<const RouteGraph>(make_route_graph(*network_))),
      rules_(*network_, options_, leniency),
      weights_(weigh_all(*graph_, rules_)),
      guide_(make_guide(*graph_, *network_, weights_)),
      search_(*graph_) {}

RouteSolver::RouteSolver(const RouteSolver& other, const RouteOptions& options, Leniency leniency)
    : options_(options),
      network_(other.network_),
      graph_(other.graph_),
      rules_(*network_, options_, leniency),
      weights_(weigh_all(*graph_, rules_)),
      guide_(make_guide(*graph_, *network_, weights_)),
      search_(*graph_) {}

std::optional<Way> RouteSolver::solve(const map::LanePlace& from, const map::LanePlace& to) {
  return solve_with(weights_, from, to);
}

std::optional<Way> RouteSolver::solve_with(std::span<const Ticks> weights,
                                           const map::LanePlace& from, const map::LanePlace& to) {
  RouteTask asked = task(from, to);
  const GraphPath path = search_.find(weights, guide_, asked.start.seeds, asked.goal.seeds);
  return answer(std::move(asked), path);
}

RouteTask RouteSolver::task(const map::LanePlace& from, const map::LanePlace& to) const {
  return {leave_from(*graph_, rules_, from), arrive_at(*graph_, rules_, to),
          direct_way(rules_, from, to)};
}

std::optional<Way> RouteSolver::answer(RouteTask task, const GraphPath& path) const {
  if (task.direct && task.direct->cost <= path.cost) {
    return Way{{std::move(task.direct->passage)}, task.direct->cost};
  }
  if (path.cost == kNever) return {};
  return way_along(task.start, task.goal, path);
}

Way RouteSolver::way_along(const RouteEnd& start, const RouteEnd& goal,
                           const GraphPath& path) const {
  Way way{{start.passages[path.from_seed]}, path.cost};
  std::uint32_t lane = graph_->lane_of_node[start.seeds[path.from_seed].node];
  std::vector<std::uint32_t> chain{lane};
  for (const std::uint32_t arc : path.arcs) {
    const std::uint32_t to = graph_->lane_of_node[graph_->head[arc]];
    if (graph_->is_change(arc)) {
      chain = chain_between(*network_, chain.front(), to);
      continue;
    }
    auto changes = rules_.plan_changes(chain, {});
    way.passages.push_back({std::move(chain), {}, changes ? *std::move(changes) : ChangePlan{}});
    chain = {to};
  }
  way.passages.push_back(goal.passages[path.to_seed]);
  return way;
}

std::vector<std::uint32_t> RouteSolver::lanes_of(const RouteEnd& end, std::uint32_t own,
                                                 bool backward) {
  std::vector<std::uint32_t> lanes{own};
  for (const Passage& passage : end.passages) {
    lanes.push_back(backward ? passage.chain.front() : passage.chain.back());
  }
  for (const Settled& settled : search_.reach(weights_, end.seeds, kNever - 1, backward)) {
    lanes.push_back(graph_->lane_of_node[settled.node]);
  }
  std::sort(lanes.begin(), lanes.end());
  lanes.erase(std::unique(lanes.begin(), lanes.end()), lanes.end());
  return lanes;
}

std::vector<Settled> RouteSolver::nodes_within(const map::LanePlace& from, Ticks limit) {
  return search_.reach(weights_, leave_from(*graph_, rules_, from).seeds, limit);
}

std::vector<std::uint32_t> RouteSolver::lanes_from(const map::LanePlace& place) {
  return lanes_of(leave_from(*graph_, rules_, place), place.lane.index, false);
}

std::vector<std::uint32_t> RouteSolver::lanes_to(const map::LanePlace& place) {
  return lanes_of(arrive_at(*graph_, rules_, place), place.lane.index, true);
}

}  // namespace roadbed::planning
