#include "roadbed/planning/route/change_span.h"

#include <algorithm>

namespace roadbed::planning::inline route {
namespace {

constexpr double kAtEnd_m = 1e-6;

// Part of a lane group that the change may use.
FractionRange part_of(const RouteNetwork& network, const ChangeSpan& span, std::size_t lane_group) {
  const double length_m = network.lanes[span.lanes[lane_group].from].length_m;
  return {lane_group == 0 ? span.start_s_m / length_m : 0.0,
          lane_group + 1 == span.lanes.size() ? span.end_s_m / length_m : 1.0};
}

double part_m(const RouteNetwork& network, const ChangeSpan& span, std::size_t lane_group) {
  const FractionRange part = part_of(network, span, lane_group);
  return (part.to - part.from) * network.lanes[span.lanes[lane_group].from].length_m;
}

LaneChain chain_of(const RouteNetwork& network, const ChangeSpan::Beside& lanes) {
  return chain_between(network, lanes.from, lanes.to);
}

// The window from one lane of a chain to the next, as fractions of the lane.
std::optional<FractionRange> window(const RouteNetwork& network, std::uint32_t lane,
                                    std::uint32_t beside, bool at_end) {
  const auto windows = windows_to(network, lane, beside);
  if (windows.empty()) return {};
  const double length_m = network.lanes[lane].length_m;
  const map::StationRange& range = at_end ? windows.back() : windows.front();
  const bool reaches = at_end ? range.to_s_m >= length_m - kAtEnd_m : range.from_s_m <= kAtEnd_m;
  if (!reaches || !(length_m > 0.0)) return {};
  return FractionRange{range.from_s_m / length_m, range.to_s_m / length_m};
}

std::optional<map::StationRange> common_window(const RouteNetwork& network, const LaneChain& chain,
                                               bool at_end) {
  FractionRange common;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const auto range = window(network, chain[i], chain[i + 1], at_end);
    if (!range) return {};
    common = {std::max(common.from, range->from), std::min(common.to, range->to)};
  }
  const double length_m = network.lanes[chain.front()].length_m;
  return map::StationRange{common.from * length_m, common.to * length_m};
}

/// Spans of one number of changes to one side.
struct SpanSearch {
  const RouteNetwork& network;
  std::uint32_t NetworkLane::*side;
  double enough_m;
  std::vector<ChangeSpan>& spans;

  void extend(const ChangeSpan& open, const LaneChain& chain, double room_m) const {
    for (const std::uint32_t next : network.successors.of(chain.front())) {
      const LaneChain ahead = lanes_beside(network, next, side, open.changes);
      if (ahead.empty() || !lead_to(network, chain, ahead)) continue;
      const auto window = window_at_start(network, ahead);
      if (!window || window->to_s_m < kLeastPart_m || spans.size() >= kMostSpans) continue;
      ChangeSpan longer = open;
      longer.lanes.push_back({next, ahead.back()});
      longer.end_s_m = window->to_s_m;
      spans.push_back(longer);
      const double length_m = network.lanes[next].length_m;
      if (window->to_s_m < length_m - kAtEnd_m || room_m + length_m >= enough_m) continue;
      extend(longer, ahead, room_m + length_m);
    }
  }
};

void add_spans(const RouteNetwork& network, const LaneChain& chain, double from_s_m,
               double enough_m, const SpanSearch& search) {
  const auto window = window_at_end(network, chain);
  if (!window) return;
  const double start_m = std::max(from_s_m, window->from_s_m);
  const double room_m = network.lanes[chain.front()].length_m - start_m;
  if (room_m < kLeastPart_m || room_m >= enough_m) return;
  search.extend({chain.size() - 1, {{chain.front(), chain.back()}}, start_m, 0.0}, chain, room_m);
}

// Changes whose middle lies before a length of the span.
std::size_t made_before(double length_m, double room_m, std::size_t changes) {
  std::size_t made = 0;
  while (made < changes && (static_cast<double>(made) + 0.5) * room_m <= length_m + kAtEnd_m) {
    ++made;
  }
  return made;
}

}  // namespace

LaneChain lanes_beside(const RouteNetwork& network, std::uint32_t lane,
                       std::uint32_t NetworkLane::*side, std::size_t count) {
  LaneChain chain{lane};
  while (chain.size() <= count) {
    const std::uint32_t next = network.lanes[chain.back()].*side;
    if (next == kNoLane || std::find(chain.begin(), chain.end(), next) != chain.end()) return {};
    chain.push_back(next);
  }
  return chain;
}

bool lead_to(const RouteNetwork& network, const LaneChain& lanes, const LaneChain& next) {
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    const auto successors = network.successors.of(lanes[i]);
    if (std::find(successors.begin(), successors.end(), next[i]) == successors.end()) return false;
  }
  return true;
}

std::optional<map::StationRange> window_at_end(const RouteNetwork& network,
                                               const LaneChain& chain) {
  return common_window(network, chain, true);
}

std::optional<map::StationRange> window_at_start(const RouteNetwork& network,
                                                 const LaneChain& chain) {
  return common_window(network, chain, false);
}

double room_m(const RouteNetwork& network, const ChangeSpan& span) {
  double room_m = 0.0;
  for (std::size_t i = 0; i < span.lanes.size(); ++i) room_m += part_m(network, span, i);
  return room_m;
}

bool needs_first(const RouteNetwork& network, const ChangeSpan& span, double enough_m) {
  const double first_m = part_m(network, span, 0);
  const double last_m = part_m(network, span, span.lanes.size() - 1);
  if (span.changes > 1 && (first_m >= enough_m || last_m >= enough_m)) return false;
  return room_m(network, span) - first_m < enough_m * static_cast<double>(span.changes);
}

std::vector<ChangeSpan> spans_from(const RouteNetwork& network, std::uint32_t lane, double from_s_m,
                                   double enough_m) {
  std::vector<ChangeSpan> spans;
  for (const auto side : {&NetworkLane::left, &NetworkLane::right}) {
    for (std::size_t changes = 1; changes <= kMostTogether; ++changes) {
      const LaneChain chain = lanes_beside(network, lane, side, changes);
      if (chain.empty()) break;
      const double all_m = enough_m * static_cast<double>(changes);
      add_spans(network, chain, from_s_m, enough_m, {network, side, all_m, spans});
    }
  }
  return spans;
}

std::optional<SpanPlan> plan_span(const RoutingCostModel& model, const ChangeSpan& span) {
  const RouteNetwork& network = model.network();
  for (const ChangeSpan::Beside& lanes : span.lanes) {
    const LaneChain chain = chain_of(network, lanes);
    // Neighbours that go round in a ring have a shorter chain the other way.
    if (chain.size() != span.changes + 1) return {};
    if (!std::all_of(chain.begin(), chain.end(), [&](std::uint32_t lane) {
          return model.may_enter(lane) && !model.is_blocked(lane, {});
        })) {
      return {};
    }
  }
  SpanPlan plan;
  plan.room_m = room_m(network, span) / static_cast<double>(span.changes);
  if (plan.room_m < model.least_room_m()) return {};
  double length_m = 0.0;
  for (std::size_t i = 0; i < span.lanes.size(); ++i) {
    plan.begin_m.push_back(length_m);
    length_m += part_m(network, span, i);
    plan.made.push_back(made_before(length_m, plan.room_m, span.changes));
  }
  return plan;
}

double cost_of(const RoutingCostModel& model, const ChangeSpan& span, const SpanPlan& plan,
               FractionRange ends) {
  double cost = model.change_cost(span.changes, plan.room_m);
  for (std::size_t i = 0; i < span.lanes.size(); ++i) {
    const LaneChain chain = chain_of(model.network(), span.lanes[i]);
    const std::uint32_t left = chain[plan.made[i]];
    const double length_m = model.network().lanes[left].length_m;
    const double from = i == 0 ? ends.from : 0.0, to = i + 1 == span.lanes.size() ? ends.to : 1.0;
    cost += model.travel_cost(left, from * length_m, to * length_m);
    if (i > 0) cost += model.turn_cost(chain[plan.made[i - 1]]);
  }
  return cost;
}

std::vector<LaneGroup> lane_groups_of(const RouteNetwork& network, const ChangeSpan& span,
                                      const SpanPlan& plan, FractionRange ends) {
  std::vector<LaneGroup> lane_groups;
  for (std::size_t i = 0; i < span.lanes.size(); ++i) {
    const LaneChain chain = chain_of(network, span.lanes[i]);
    const std::size_t entered = i == 0 ? 0 : plan.made[i - 1], left = plan.made[i];
    LaneGroup lane_group{std::span(chain).subspan(entered, left + 1 - entered),
                         {i == 0 ? ends.from : 0.0, i + 1 == span.lanes.size() ? ends.to : 1.0},
                         {}};
    lane_group.changes.room_m = plan.room_m;
    const double length_m = network.lanes[span.lanes[i].from].length_m;
    const double first_m = (i == 0 ? span.start_s_m : 0.0) - plan.begin_m[i];
    for (std::size_t j = entered; j < left; ++j) {
      const double from_m = first_m + static_cast<double>(j) * plan.room_m;
      lane_group.changes.ranges.push_back({from_m / length_m, (from_m + plan.room_m) / length_m});
    }
    lane_groups.push_back(std::move(lane_group));
  }
  return lane_groups;
}

}  // namespace roadbed::planning::route
