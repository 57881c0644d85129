#include "roadbed/planning/route/route_solver.h"

#include <algorithm>
#include <iterator>

#include "roadbed/planning/route/hierarchy.h"

namespace roadbed::planning::inline route {

RouteSolver::RouteSolver(std::shared_ptr<const RouteNetwork> network, const RouteOptions& options,
                         RelaxedRules relaxed)
    : options_(options),
      network_(std::move(network)),
      graph_(
          std::make_shared<const RouteGraph>(make_route_graph(*network_, enough_room_m(options)))),
      model_(*network_, options_, relaxed),
      weights_(weigh_all(*graph_, model_)),
      guide_(make_guide(*graph_, *network_, weights_)),
      search_(*graph_) {}

RouteSolver::RouteSolver(const RouteSolver& other, const RouteOptions& options,
                         RelaxedRules relaxed)
    : options_(options),
      network_(other.network_),
      graph_(other.graph_),
      model_(*network_, options_, relaxed),
      weights_(weigh_all(*graph_, model_)),
      guide_(make_guide(*graph_, *network_, weights_)),
      search_(*graph_) {}

std::optional<Way> RouteSolver::solve(const RoutePlace& from, const RoutePlace& to) {
  if (tree_ == nullptr) return solve_with(weights_, from, to);
  RouteTask asked = task(from, to);
  const GraphPath path = tree_->search.find(asked.start.seeds, asked.goal.seeds);
  return answer(std::move(asked), path);
}

RouteSolver::Tree::Tree(const RouteGraph& graph, const Guide& guide, std::span<const Ticks> weights)
    : hierarchy(make_hierarchy(graph, dissection_order(graph, guide.place_in_map))),
      metric(graph, hierarchy, weights),
      search(metric) {}

void RouteSolver::prepare() { tree_ = std::make_unique<Tree>(*graph_, guide_, weights_); }

std::optional<Way> RouteSolver::solve_with(std::span<const Ticks> weights, const RoutePlace& from,
                                           const RoutePlace& to) {
  RouteTask asked = task(from, to);
  const GraphPath path = search_.find(weights, guide_, asked.start.seeds, asked.goal.seeds);
  return answer(std::move(asked), path);
}

RouteTask RouteSolver::task(const RoutePlace& from, const RoutePlace& to) const {
  return {leave_from(*graph_, model_, from), arrive_at(*graph_, model_, to),
          direct_way(model_, from, to)};
}

std::optional<Way> RouteSolver::answer(RouteTask task, const GraphPath& path) const {
  if (task.direct && task.direct->cost <= path.cost) {
    return Way{std::move(task.direct->lane_groups), task.direct->cost};
  }
  if (path.cost == kNever) return {};
  return way_along(task.start, task.goal, path);
}

Way RouteSolver::way_along(const RouteEnd& start, const RouteEnd& goal,
                           const GraphPath& path) const {
  Way way{{}, path.cost};
  std::vector<LaneGroup>& lane_groups = way.lane_groups;
  const std::vector<LaneGroup>&first = start.ways[path.from_seed], &last = goal.ways[path.to_seed];
  const auto advances = static_cast<std::size_t>(
      std::count_if(path.arcs.begin(), path.arcs.end(),
                    [&](std::uint32_t arc) { return graph_->is_advance(arc); }));
  lane_groups.reserve(first.size() + 1 + advances + last.size());
  lane_groups.insert(lane_groups.end(), first.begin(), first.end());
  // From here on the last lane group is one that is entered, but not left yet.
  const auto enter = [&](std::uint32_t lane) {
    lane_groups.emplace_back();
    lane_groups.back().chain = LaneList(lane);
  };
  const bool in_last = first.size() > 1;
  if (!in_last) enter(graph_->lane_of_node[start.seeds[path.from_seed].node]);
  for (const std::uint32_t arc : path.arcs) {
    if (graph_->is_advance(arc)) {
      enter(graph_->lane_of_node[graph_->head[arc]]);
      continue;
    }
    const bool stays = graph_->lane_of_node[graph_->head[arc]] == lane_groups.back().chain.front();
    if (stays && graph_->span_of(arc) == nullptr) continue;
    std::vector<LaneGroup> changing = lane_groups_of_change(lane_groups.back().chain.front(), arc);
    lane_groups.pop_back();
    std::move(changing.begin(), changing.end(), std::back_inserter(lane_groups));
  }
  lane_groups.pop_back();
  lane_groups.insert(lane_groups.end(), last.begin(), last.end());
  return way;
}

std::vector<LaneGroup> RouteSolver::lane_groups_of_change(std::uint32_t from,
                                                          std::uint32_t arc) const {
  if (const ChangeSpan* span = graph_->span_of(arc)) {
    const auto plan = plan_span(model_, *span);
    return lane_groups_of(*network_, *span, plan.value(), {});
  }
  LaneGroup lane_group{
      chain_between(*network_, from, graph_->lane_of_node[graph_->head[arc]]), {}, {}};
  lane_group.changes = model_.plan_changes(lane_group.chain, {}).value_or(ChangePlan{});
  return {std::move(lane_group)};
}

std::vector<std::uint32_t> RouteSolver::lanes_of(const RouteEnd& end, const RoutePlace& own,
                                                 bool backward) {
  std::vector<std::uint32_t> lanes;
  for (const NetworkPlace& way : ways_through(*network_, own)) {
    if (model_.may_enter(way.lane)) lanes.push_back(way.lane);
  }
  for (const std::vector<LaneGroup>& way : end.ways) {
    lanes.push_back(backward ? way.front().chain.front() : way.back().chain.back());
  }
  for (const Settled& settled : search_.reach(weights_, end.seeds, kNever - 1, backward)) {
    lanes.push_back(graph_->lane_of_node[settled.node]);
  }
  std::sort(lanes.begin(), lanes.end());
  lanes.erase(std::unique(lanes.begin(), lanes.end()), lanes.end());
  return lanes;
}

std::vector<Settled> RouteSolver::nodes_within(const RoutePlace& from, Ticks limit) {
  return search_.reach(weights_, leave_from(*graph_, model_, from).seeds, limit);
}

std::vector<std::uint32_t> RouteSolver::lanes_from(const RoutePlace& place) {
  return lanes_of(leave_from(*graph_, model_, place), place, false);
}

std::vector<std::uint32_t> RouteSolver::lanes_to(const RoutePlace& place) {
  return lanes_of(arrive_at(*graph_, model_, place), place, true);
}

}  // namespace roadbed::planning::route
