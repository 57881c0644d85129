#include "roadbed/planning/change_span.h"

#include <algorithm>
#include <numeric>

namespace roadbed::planning {
namespace {

constexpr double kAtEnd_m = 1e-6;
constexpr double kLeastPart_m = 0.1;  // of a passage, to be worth beginning in it
constexpr std::size_t kMostSpans = 64;

// Part of a passage that the change may use.
ShareRange part_of(const RouteNetwork& network, const ChangeSpan& span, std::size_t passage) {
  const double length_m = network.lanes[span.lanes[passage].from].length_m;
  return {passage == 0 ? span.start_s_m / length_m : 0.0,
          passage + 1 == span.lanes.size() ? span.end_s_m / length_m : 1.0};
}

double part_m(const RouteNetwork& network, const ChangeSpan& span, std::size_t passage) {
  const ShareRange part = part_of(network, span, passage);
  return (part.to - part.from) * network.lanes[span.lanes[passage].from].length_m;
}

void extend(const RouteNetwork& network, const ChangeSpan& open, double room_m, double enough_m,
            std::uint32_t NetworkLane::*side, std::vector<ChangeSpan>& spans) {
  const ChangeSpan::Beside last = open.lanes.back();
  for (const std::uint32_t next : network.successors.of(last.from)) {
    const std::uint32_t beside = network.lanes[next].*side;
    if (beside == kNoLane || !leads_to(network, last.to, beside)) continue;
    const auto window = window_at_start(network, next, beside);
    if (!window || window->to_s_m < kLeastPart_m || spans.size() >= kMostSpans) continue;
    ChangeSpan longer = open;
    longer.lanes.push_back({next, beside});
    longer.end_s_m = window->to_s_m;
    spans.push_back(longer);
    const double length_m = network.lanes[next].length_m;
    if (window->to_s_m < length_m - kAtEnd_m || room_m + length_m >= enough_m) continue;
    extend(network, longer, room_m + length_m, enough_m, side, spans);
  }
}

}  // namespace

bool leads_to(const RouteNetwork& network, std::uint32_t lane, std::uint32_t next) {
  const auto successors = network.successors.of(lane);
  return std::find(successors.begin(), successors.end(), next) != successors.end();
}

std::optional<map::StationRange> window_at_end(const RouteNetwork& network, std::uint32_t lane,
                                               std::uint32_t beside) {
  const auto windows = windows_to(network, lane, beside);
  if (windows.empty()) return {};
  const bool reaches = windows.back().to_s_m >= network.lanes[lane].length_m - kAtEnd_m;
  return reaches ? std::optional(windows.back()) : std::nullopt;
}

std::optional<map::StationRange> window_at_start(const RouteNetwork& network, std::uint32_t lane,
                                                 std::uint32_t beside) {
  const auto windows = windows_to(network, lane, beside);
  if (windows.empty() || windows.front().from_s_m > kAtEnd_m) return {};
  return windows.front();
}

double room_m(const RouteNetwork& network, const ChangeSpan& span) {
  double room_m = 0.0;
  for (std::size_t i = 0; i < span.lanes.size(); ++i) room_m += part_m(network, span, i);
  return room_m;
}

bool needs_first(const RouteNetwork& network, const ChangeSpan& span, double enough_m) {
  return room_m(network, span) - part_m(network, span, 0) < enough_m;
}

std::vector<ChangeSpan> spans_from(const RouteNetwork& network, std::uint32_t lane, double from_s_m,
                                   double enough_m) {
  std::vector<ChangeSpan> spans;
  const NetworkLane& first = network.lanes[lane];
  for (const auto side : {&NetworkLane::left, &NetworkLane::right}) {
    if (first.*side == kNoLane) continue;
    const auto window = window_at_end(network, lane, first.*side);
    if (!window) continue;
    const double start_m = std::max(from_s_m, window->from_s_m);
    const double room_m = first.length_m - start_m;
    if (room_m < kLeastPart_m || room_m >= enough_m) continue;
    extend(network, {{{lane, first.*side}}, start_m, 0.0}, room_m, enough_m, side, spans);
  }
  return spans;
}

std::optional<SpanPlan> plan_span(const TravelRules& rules, const ChangeSpan& span) {
  const RouteNetwork& network = rules.network();
  for (const ChangeSpan::Beside& lanes : span.lanes) {
    if (!rules.may_enter(lanes.from) || !rules.may_enter(lanes.to)) return {};
  }
  SpanPlan plan;
  plan.changes.room_m = room_m(network, span);
  if (plan.changes.room_m < rules.least_room_m()) return {};
  const double middle_m = 0.5 * plan.changes.room_m;
  double here_m = part_m(network, span, 0);
  while (plan.passage + 1 < span.lanes.size() &&
         plan.changes.before_m + here_m < middle_m - kAtEnd_m) {
    plan.changes.before_m += here_m;
    here_m = part_m(network, span, ++plan.passage);
  }
  plan.changes.behind_m = plan.changes.room_m - plan.changes.before_m - here_m;
  plan.changes.ranges = {part_of(network, span, plan.passage)};
  return plan;
}

double cost_of(const TravelRules& rules, const ChangeSpan& span, const SpanPlan& plan,
               ShareRange ends) {
  double cost = rules.change_cost(1, plan.changes.room_m);
  for (std::size_t i = 0; i < span.lanes.size(); ++i) {
    const std::uint32_t entered = i <= plan.passage ? span.lanes[i].from : span.lanes[i].to;
    const std::uint32_t left = i < plan.passage ? span.lanes[i].from : span.lanes[i].to;
    const double length_m = rules.network().lanes[left].length_m;
    const double from = i == 0 ? ends.from : 0.0, to = i + 1 == span.lanes.size() ? ends.to : 1.0;
    cost += rules.travel_cost(left, from * length_m, to * length_m);
    if (i > 0) cost += rules.turn_cost(entered);
  }
  return cost;
}

std::vector<Passage> passages_of(const ChangeSpan& span, const SpanPlan& plan, ShareRange ends) {
  std::vector<Passage> passages;
  for (std::size_t i = 0; i < span.lanes.size(); ++i) {
    const auto [from, to] = span.lanes[i];
    Passage passage{{i <= plan.passage ? from : to},
                    {i == 0 ? ends.from : 0.0, i + 1 == span.lanes.size() ? ends.to : 1.0},
                    {}};
    if (i == plan.passage) {
      passage.chain.push_back(to);
      passage.changes = plan.changes;
    }
    passages.push_back(std::move(passage));
  }
  return passages;
}

}  // namespace roadbed::planning
