#include "roadbed/planning/route_ends.h"

#include <algorithm>

namespace roadbed::planning {
namespace {

double share_of(const RouteNetwork& network, const map::LanePlace& place) {
  const double length_m = network.lanes[place.lane.index].length_m;
  return length_m > 0.0 ? std::clamp(place.s_m / length_m, 0.0, 1.0) : 0.0;
}

// Cost of the changes of a passage and of the way along its last lane.
std::optional<double> price(const TravelRules& rules, Passage& passage) {
  auto changes = rules.plan_changes(passage.chain, passage.range);
  if (!changes) return {};
  passage.changes = std::move(*changes);
  const std::uint32_t last = passage.chain.back();
  const double length_m = rules.network().lanes[last].length_m;
  return rules.change_cost(passage.chain.size() - 1, passage.changes.room_m) +
         rules.travel_cost(last, passage.range.from * length_m, passage.range.to * length_m);
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
    if (graph.is_change(arc) && from != lane) chains.push_back(chain_between(network, from, lane));
  }
  return chains;
}

}  // namespace

RouteEnd leave_from(const RouteGraph& graph, const TravelRules& rules,
                    const map::LanePlace& place) {
  RouteEnd end;
  const RouteNetwork& network = rules.network();
  const RouteCost measure = rules.options().cost;
  for (const auto& chain : chains_from(network, place.lane.index)) {
    Passage passage{chain, {share_of(network, place), 1.0}, {}};
    const auto cost = price(rules, passage);
    if (!cost) continue;
    for (const std::uint32_t next : network.successors.of(chain.back())) {
      if (!rules.may_enter(next)) continue;
      end.seeds.push_back(
          {graph.entry_of_lane[next], to_ticks(*cost + rules.turn_cost(next), measure)});
      end.passages.push_back(passage);
    }
  }
  return end;
}

RouteEnd arrive_at(const RouteGraph& graph, const TravelRules& rules, const map::LanePlace& place) {
  RouteEnd end;
  const RouteNetwork& network = rules.network();
  for (const auto& chain : chains_to(graph, network, place.lane.index)) {
    Passage passage{chain, {0.0, share_of(network, place)}, {}};
    if (!rules.may_enter(chain.front())) continue;
    const auto cost = price(rules, passage);
    if (!cost) continue;
    end.seeds.push_back(
        {graph.entry_of_lane[chain.front()], to_ticks(*cost, rules.options().cost)});
    end.passages.push_back(std::move(passage));
  }
  return end;
}

std::optional<DirectWay> direct_way(const TravelRules& rules, const map::LanePlace& from,
                                    const map::LanePlace& to) {
  const RouteNetwork& network = rules.network();
  Passage passage{chain_between(network, from.lane.index, to.lane.index),
                  {share_of(network, from), share_of(network, to)},
                  {}};
  if (passage.chain.empty() || passage.range.from > passage.range.to) return {};
  const auto cost = price(rules, passage);
  if (!cost) return {};
  return DirectWay{std::move(passage), to_ticks(*cost, rules.options().cost)};
}

}  // namespace roadbed::planning
