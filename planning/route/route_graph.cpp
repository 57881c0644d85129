#include "roadbed/planning/route/route_graph.h"

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline route {
namespace {

bool has_neighbour(const NetworkLane& lane) {
  return lane.left != kNoLane || lane.right != kNoLane;
}

std::vector<bool> lanes_changed_to(const RouteNetwork& network) {
  std::vector<bool> changed_to(network.lanes.size(), false);
  for (const NetworkLane& lane : network.lanes) {
    for (const std::uint32_t beside : {lane.left, lane.right}) {
      if (beside != kNoLane) changed_to[beside] = true;
    }
  }
  return changed_to;
}

void add_nodes(const RouteNetwork& network, RouteGraph& graph) {
  const std::vector<bool> changed_to = lanes_changed_to(network);
  for (std::uint32_t lane = 0; lane < network.lanes.size(); ++lane) {
    graph.entry_of_lane.push_back(static_cast<std::uint32_t>(graph.nodes()));
    graph.lane_of_node.push_back(lane);
    if (changed_to[lane]) graph.lane_of_node.push_back(lane);
    graph.exit_of_lane.push_back(static_cast<std::uint32_t>(graph.nodes()) - 1);
  }
}

void add_arc(RouteGraph& graph, std::uint32_t from, std::uint32_t to) {
  graph.tail.push_back(from);
  graph.head.push_back(to);
}

void add_spans(const RouteNetwork& network, std::uint32_t node, double enough_m,
               RouteGraph& graph) {
  for (ChangeSpan& span : spans_from(network, graph.lane_of_node[node], 0.0, enough_m)) {
    if (!needs_first(network, span, enough_m)) continue;
    const auto arc = static_cast<std::uint32_t>(graph.arcs());
    for (const auto [from, to] : span.lanes) {
      for (const std::uint32_t lane : chain_between(network, from, to)) {
        graph.spans_over.push_back({lane, arc});
      }
    }
    add_arc(graph, node, graph.exit_of_lane[span.lanes.back().to]);
    graph.span_arcs.push_back(arc);
    graph.spans.push_back(std::move(span));
  }
}

void add_arcs_of(const RouteNetwork& network, std::uint32_t node, double enough_m,
                 RouteGraph& graph) {
  const std::uint32_t lane = graph.lane_of_node[node];
  const bool is_entry = graph.entry_of_lane[lane] == node;
  const bool is_exit = graph.exit_of_lane[lane] == node;
  graph.first_out.push_back(static_cast<std::uint32_t>(graph.arcs()));
  if (is_entry && (!is_exit || has_neighbour(network.lanes[lane]))) {
    for (const auto& chain : chains_from(network, lane)) {
      const std::uint32_t to = graph.exit_of_lane[chain.back()];
      if (to != node) add_arc(graph, node, to);
    }
    add_spans(network, node, enough_m, graph);
  }
  graph.first_advance.push_back(static_cast<std::uint32_t>(graph.arcs()));
  if (!is_exit) return;
  for (const std::uint32_t next : network.successors.of(lane)) {
    add_arc(graph, node, graph.entry_of_lane[next]);
  }
}

// A counting sort of the arcs by their heads; it is stable, so arcs to a node stay in order.
void add_backward_rows(RouteGraph& graph) {
  graph.first_in.assign(graph.nodes() + 1, 0);
  for (const std::uint32_t to : graph.head) ++graph.first_in[to + 1];
  for (std::size_t i = 0; i < graph.nodes(); ++i) graph.first_in[i + 1] += graph.first_in[i];
  std::vector<std::uint32_t> next(graph.first_in.begin(), graph.first_in.end() - 1);
  graph.in_arc.resize(graph.arcs());
  for (std::uint32_t arc = 0; arc < graph.arcs(); ++arc)
    graph.in_arc[next[graph.head[arc]]++] = arc;
}

Ticks weigh_change(const RouteNetwork& network, const RoutingCostModel& model, std::uint32_t from,
                   std::uint32_t to) {
  const auto chain = chain_between(network, from, to);
  const auto plan = model.plan_changes(chain, {});
  return plan ? to_ticks(model.change_cost(chain.size() - 1, plan->room_m), model.options().cost)
              : kNever;
}

Ticks weigh_span(const RoutingCostModel& model, const ChangeSpan& span) {
  const auto plan = plan_span(model, span);
  return plan ? to_ticks(cost_of(model, span, *plan, {0.0, 0.0}), model.options().cost) : kNever;
}

}  // namespace

double ticks_per_unit(RouteCost cost) { return cost == RouteCost::time ? 1e4 : 1e3; }

Ticks to_ticks(double cost, RouteCost measure) {
  const double ticks = std::round(cost * ticks_per_unit(measure));
  return ticks < static_cast<double>(kNever) ? static_cast<Ticks>(ticks) : kNever;
}

const ChangeSpan* RouteGraph::span_of(std::uint32_t arc) const {
  const auto at = std::lower_bound(span_arcs.begin(), span_arcs.end(), arc);
  return at != span_arcs.end() && *at == arc
             ? &spans[static_cast<std::size_t>(at - span_arcs.begin())]
             : nullptr;
}

RouteGraph make_route_graph(const RouteNetwork& network, double enough_m) {
  RouteGraph graph;
  add_nodes(network, graph);
  for (std::uint32_t node = 0; node < graph.nodes(); ++node) {
    add_arcs_of(network, node, enough_m, graph);
  }
  std::sort(graph.spans_over.begin(), graph.spans_over.end());
  graph.first_out.push_back(static_cast<std::uint32_t>(graph.arcs()));
  add_backward_rows(graph);
  return graph;
}

Ticks weigh(const RouteGraph& graph, const RoutingCostModel& model, std::uint32_t arc) {
  const std::uint32_t from = graph.lane_of_node[graph.tail[arc]];
  const std::uint32_t to = graph.lane_of_node[graph.head[arc]];
  if (!model.may_enter(from) || !model.may_enter(to)) return kNever;
  if (!graph.is_advance(arc)) {
    const ChangeSpan* span = graph.span_of(arc);
    return span != nullptr ? weigh_span(model, *span)
                           : weigh_change(model.network(), model, from, to);
  }
  const bool is_driven_whole = graph.entry_of_lane[from] == graph.exit_of_lane[from];
  if (is_driven_whole && model.is_blocked(from, {})) return kNever;
  const double length_m = model.network().lanes[from].length_m;
  return to_ticks(model.travel_cost(from, 0.0, length_m) + model.turn_cost(to),
                  model.options().cost);
}

std::vector<Ticks> weigh_all(const RouteGraph& graph, const RoutingCostModel& model) {
  std::vector<Ticks> weights;
  weights.reserve(graph.arcs());
  for (std::uint32_t arc = 0; arc < graph.arcs(); ++arc) {
    weights.push_back(weigh(graph, model, arc));
  }
  return weights;
}

std::vector<std::uint32_t> arcs_of_lane(const RouteGraph& graph, std::uint32_t lane) {
  std::vector<std::uint32_t> arcs;
  const auto add_out = [&](std::uint32_t node) {
    for (std::uint32_t arc = graph.first_out[node]; arc < graph.first_out[node + 1]; ++arc) {
      arcs.push_back(arc);
    }
  };
  const auto add_in = [&](std::uint32_t node) {
    for (std::uint32_t i = graph.first_in[node]; i < graph.first_in[node + 1]; ++i) {
      const std::uint32_t arc = graph.in_arc[i];
      arcs.push_back(arc);
      // A change over several lanes passes over those between.
      if (!graph.is_advance(arc)) add_out(graph.tail[arc]);
    }
  };
  for (const std::uint32_t node : {graph.entry_of_lane[lane], graph.exit_of_lane[lane]}) {
    add_out(node);
    add_in(node);
  }
  for (auto over = std::lower_bound(graph.spans_over.begin(), graph.spans_over.end(),
                                    std::pair(lane, std::uint32_t{0}));
       over != graph.spans_over.end() && over->first == lane; ++over) {
    arcs.push_back(over->second);
  }
  std::sort(arcs.begin(), arcs.end());
  arcs.erase(std::unique(arcs.begin(), arcs.end()), arcs.end());
  return arcs;
}

}  // namespace roadbed::planning::route
