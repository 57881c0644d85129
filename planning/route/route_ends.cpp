#include "roadbed/planning/route/route_solver.h"

#include <algorithm>

namespace roadbed::planning::inline route {
namespace {

constexpr double kSectionEnd_m = 1e-6;

double fraction_of(const RouteNetwork& network, const NetworkPlace& place) {
  const double length_m = network.lanes[place.lane].length_m;
  return length_m > 0.0 ? std::clamp(place.s_m / length_m, 0.0, 1.0) : 0.0;
}

// Cost of the changes of a lane group and of the way along its last lane.
std::optional<double> price(const RoutingCostModel& model, LaneGroup& lane_group) {
  auto changes = model.plan_changes(lane_group.chain, lane_group.range);
  if (!changes) return {};
  lane_group.changes = std::move(*changes);
  const std::uint32_t last = lane_group.chain.back();
  const double length_m = model.network().lanes[last].length_m;
  return model.change_cost(lane_group.chain.size() - 1, lane_group.changes.room_m) +
         model.travel_cost(last, lane_group.range.from * length_m, lane_group.range.to * length_m);
}

// Chains that end in the lane. Neighbours need not be neighbours both ways: so from all lanes that
// changes into it come from.
std::vector<std::vector<std::uint32_t>> chains_to(const RouteGraph& graph,
                                                  const RouteNetwork& network, std::uint32_t lane) {
  std::vector<std::vector<std::uint32_t>> chains{{lane}};
  const std::uint32_t node = graph.exit_of_lane[lane];
  for (std::uint32_t i = graph.first_in[node]; i < graph.first_in[node + 1]; ++i) {
    const std::uint32_t arc = graph.in_arc[i];
    const std::uint32_t from = graph.lane_of_node[graph.tail[arc]];
    if (!graph.is_advance(arc) && graph.span_of(arc) == nullptr && from != lane) {
      chains.push_back(chain_between(network, from, lane));
    }
  }
  return chains;
}

std::vector<std::uint32_t> predecessors_of(const RouteGraph& graph, std::uint32_t lane) {
  std::vector<std::uint32_t> lanes;
  const std::uint32_t node = graph.entry_of_lane[lane];
  for (std::uint32_t i = graph.first_in[node]; i < graph.first_in[node + 1]; ++i) {
    const std::uint32_t arc = graph.in_arc[i];
    if (graph.is_advance(arc)) lanes.push_back(graph.lane_of_node[graph.tail[arc]]);
  }
  return lanes;
}

/// Changes over several lane groups that end at a place, from the last lane group backwards.
class SpansInto {
 public:
  SpansInto(const RouteGraph& graph, const RouteNetwork& network, double enough_m)
      : graph_(graph), network_(network), enough_m_(enough_m) {}

  std::vector<ChangeSpan> find(std::uint32_t lane, double fraction) {
    for (const auto& chain : chains_to(graph_, network_, lane)) {
      if (chain.size() < 2 || chain.size() > kMostTogether + 1) continue;
      const NetworkLane& from = network_.lanes[chain.front()];
      const auto window = window_at_start(network_, chain);
      if (!window) continue;
      last_m_ = std::min(window->to_s_m, fraction * from.length_m);
      if (last_m_ < kLeastPart_m || (chain.size() > 2 && last_m_ >= enough_m_)) continue;
      side_ = from.left == chain[1] ? &NetworkLane::left : &NetworkLane::right;
      extend({chain.size() - 1, {{chain.front(), lane}}, 0.0, last_m_}, chain, last_m_);
    }
    return std::move(found_);
  }

 private:
  void extend(const ChangeSpan& open, const LaneChain& chain, double room_m) {
    const double all_m = enough_m_ * static_cast<double>(open.changes);
    for (const std::uint32_t before : predecessors_of(graph_, chain.front())) {
      const LaneChain behind = lanes_beside(network_, before, side_, open.changes);
      if (behind.empty() || !lead_to(network_, behind, chain)) continue;
      const auto window = window_at_end(network_, behind);
      const double length_m = network_.lanes[before].length_m;
      if (!window || length_m - window->from_s_m < kLeastPart_m) continue;
      const double longer_m = room_m + length_m - window->from_s_m;
      // Else changes that end in the lane group before have all the room that helps.
      if (longer_m - last_m_ >= all_m) continue;
      if (found_.size() >= kMostSpans) continue;
      ChangeSpan longer = open;
      longer.lanes.insert(longer.lanes.begin(), {before, behind.back()});
      longer.start_s_m = window->from_s_m;
      if (open.changes == 1 || length_m - window->from_s_m < enough_m_) found_.push_back(longer);
      if (window->from_s_m > kSectionEnd_m || longer_m >= all_m) continue;
      extend(longer, behind, longer_m);
    }
  }

  const RouteGraph& graph_;
  const RouteNetwork& network_;
  double enough_m_, last_m_ = 0.0;
  std::uint32_t NetworkLane::*side_ = nullptr;
  std::vector<ChangeSpan> found_;
};

std::optional<DirectWay> way_in_lane_group(const RoutingCostModel& model, const NetworkPlace& from,
                                           const NetworkPlace& to) {
  const RouteNetwork& network = model.network();
  LaneGroup lane_group{chain_between(network, from.lane, to.lane),
                       {fraction_of(network, from), fraction_of(network, to)},
                       {}};
  if (lane_group.chain.empty() || lane_group.range.from > lane_group.range.to) return {};
  const auto cost = price(model, lane_group);
  if (!cost) return {};
  return DirectWay{{std::move(lane_group)}, to_ticks(*cost, model.options().cost)};
}

void leave(const RouteGraph& graph, const RoutingCostModel& model, const NetworkPlace& place,
           RouteEnd& end) {
  const RouteNetwork& network = model.network();
  const RouteCost measure = model.options().cost;
  const double fraction = fraction_of(network, place);
  if (!model.may_enter(place.lane)) return;
  for (const auto& chain : chains_from(network, place.lane)) {
    LaneGroup lane_group{chain, {fraction, 1.0}, {}};
    const auto cost = price(model, lane_group);
    if (!cost) continue;
    for (const std::uint32_t next : network.successors.of(chain.back())) {
      if (!model.may_enter(next)) continue;
      end.seeds.push_back(
          {graph.entry_of_lane[next], to_ticks(*cost + model.turn_cost(next), measure)});
      end.ways.emplace_back(1, lane_group);
    }
  }
  const double enough_m = model.enough_room_m();
  for (const ChangeSpan& span : spans_from(network, place.lane, place.s_m, enough_m)) {
    const auto plan = plan_span(model, span);
    if (!plan || !needs_first(network, span, enough_m)) continue;
    end.seeds.push_back({graph.exit_of_lane[span.lanes.back().to],
                         to_ticks(cost_of(model, span, *plan, {fraction, 0.0}), measure)});
    end.ways.push_back(lane_groups_of(network, span, *plan, {fraction, 1.0}));
  }
}

void arrive(const RouteGraph& graph, const RoutingCostModel& model, const NetworkPlace& place,
            RouteEnd& end) {
  const RouteNetwork& network = model.network();
  const RouteCost measure = model.options().cost;
  const double fraction = fraction_of(network, place);
  for (const auto& chain : chains_to(graph, network, place.lane)) {
    LaneGroup lane_group{chain, {0.0, fraction}, {}};
    if (!model.may_enter(chain.front())) continue;
    const auto cost = price(model, lane_group);
    if (!cost) continue;
    end.seeds.push_back({graph.entry_of_lane[chain.front()], to_ticks(*cost, measure)});
    end.ways.emplace_back().push_back(std::move(lane_group));
  }
  SpansInto spans(graph, network, model.enough_room_m());
  for (const ChangeSpan& span : spans.find(place.lane, fraction)) {
    const auto plan = plan_span(model, span);
    if (!plan) continue;
    end.seeds.push_back({graph.entry_of_lane[span.lanes.front().from],
                         to_ticks(cost_of(model, span, *plan, {0.0, fraction}), measure)});
    end.ways.push_back(lane_groups_of(network, span, *plan, {0.0, fraction}));
  }
}

std::optional<DirectWay> way_between(const RoutingCostModel& model, const NetworkPlace& from,
                                     const NetworkPlace& to) {
  if (!model.may_enter(from.lane) || !model.may_enter(to.lane)) return {};
  std::optional<DirectWay> best = way_in_lane_group(model, from, to);
  const FractionRange ends{fraction_of(model.network(), from), fraction_of(model.network(), to)};
  for (ChangeSpan& span : spans_from(model.network(), from.lane, from.s_m, model.enough_room_m())) {
    const auto [last, beside] = span.lanes.back();
    if (beside != to.lane) continue;
    span.end_s_m = std::min(span.end_s_m, ends.to * model.network().lanes[last].length_m);
    const auto plan = plan_span(model, span);
    if (!plan || !needs_first(model.network(), span, model.enough_room_m())) continue;
    const Ticks cost = to_ticks(cost_of(model, span, *plan, ends), model.options().cost);
    if (!best || cost < best->cost) {
      best = DirectWay{lane_groups_of(model.network(), span, *plan, ends), cost};
    }
  }
  return best;
}

}  // namespace

RouteEnd leave_from(const RouteGraph& graph, const RoutingCostModel& model,
                    const RoutePlace& place) {
  RouteEnd end;
  for (const NetworkPlace& way : ways_through(model.network(), place)) {
    leave(graph, model, way, end);
  }
  return end;
}

RouteEnd arrive_at(const RouteGraph& graph, const RoutingCostModel& model,
                   const RoutePlace& place) {
  RouteEnd end;
  for (const NetworkPlace& way : ways_through(model.network(), place)) {
    arrive(graph, model, way, end);
  }
  return end;
}

std::optional<DirectWay> direct_way(const RoutingCostModel& model, const RoutePlace& from,
                                    const RoutePlace& to) {
  std::optional<DirectWay> best;
  for (const NetworkPlace& start : ways_through(model.network(), from)) {
    for (const NetworkPlace& goal : ways_through(model.network(), to)) {
      auto way = way_between(model, start, goal);
      if (way && (!best || way->cost < best->cost)) best = std::move(way);
    }
  }
  return best;
}

}  // namespace roadbed::planning::route
