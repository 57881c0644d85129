#include "roadbed/planning/route/routing_cost_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbed::planning::inline route {
namespace {

constexpr double kLeastRoom_m = 0.1;  // a change takes some length, whatever the options say
constexpr double kRounding_m = 1e-9;
constexpr int kBisections = 60;

void extend(const RouteNetwork& network, std::vector<std::uint32_t> chain,
            std::uint32_t NetworkLane::*side, std::vector<std::vector<std::uint32_t>>& chains) {
  while (chain.size() <= kMostLaneChanges) {
    const std::uint32_t next = network.lanes[chain.back()].*side;
    if (next == kNoLane || std::find(chain.begin(), chain.end(), next) != chain.end()) return;
    chain.push_back(next);
    chains.push_back(chain);
  }
}

}  // namespace

RoutingCostModel::RoutingCostModel(const RouteNetwork& network, const RouteOptions& options,
                                   RelaxedRules relaxed)
    : network_(network),
      options_(options),
      relaxed_(relaxed),
      closed_(network.lanes.size(), false) {
  whole_cost_.reserve(network.lanes.size());
  for (std::uint32_t lane = 0; lane < network.lanes.size(); ++lane) {
    whole_cost_.push_back(sum_of_pieces(lane, 0.0, network.lanes[lane].length_m));
  }
  if (relaxed.closed_lanes) return;
  for (const map::LaneId lane : options.avoid) {
    closed_.at(lane.index) = true;
    const std::uint32_t contraflow_twin = network.lanes[lane.index].contraflow_twin;
    if (contraflow_twin != kNoLane) closed_[contraflow_twin] = true;
  }
  for (const BlockedStretch& stretch : options.blocked) {
    const NetworkLane& lane = network.lanes.at(stretch.lane.index);
    const auto [from_s_m, to_s_m] = stretch.stations;
    FractionRange part;
    if (lane.length_m > 0.0) part = {from_s_m / lane.length_m, to_s_m / lane.length_m};
    blocked_.push_back({stretch.lane.index, part});
    if (lane.contraflow_twin == kNoLane) continue;
    blocked_.push_back({lane.contraflow_twin, {1.0 - part.to, 1.0 - part.from}});
  }
}

std::vector<FractionRange> RoutingCostModel::blocked_of(std::uint32_t lane,
                                                        FractionRange part) const {
  std::vector<FractionRange> found;
  for (const BlockedPart& blocked : blocked_) {
    const bool is_met = blocked.part.from < part.to && blocked.part.to > part.from;
    if (blocked.lane == lane && is_met) found.push_back(blocked.part);
  }
  return found;
}

bool RoutingCostModel::is_blocked(std::uint32_t lane, FractionRange part) const {
  return !blocked_of(lane, part).empty();
}

double RoutingCostModel::speed_mps(std::uint32_t lane, const SpeedPiece& piece) const {
  double limit_mps = piece.limit_mps;
  if (!(limit_mps > 0.0)) {
    limit_mps = options_.default_speed_mps.value_or(default_speed_mps(network_.lanes[lane].type));
  }
  if (piece.curvature_per_m > 0.0) {
    limit_mps =
        std::min(limit_mps, std::sqrt(options_.lateral_acceleration_mps2 / piece.curvature_per_m));
  }
  return std::min(limit_mps, options_.max_speed_mps);
}

double RoutingCostModel::travel_cost(std::uint32_t lane, double from_s_m, double to_s_m) const {
  if (from_s_m <= 0.0 && to_s_m >= network_.lanes[lane].length_m) return whole_cost_[lane];
  return sum_of_pieces(lane, from_s_m, to_s_m);
}

double RoutingCostModel::sum_of_pieces(std::uint32_t lane, double from_s_m, double to_s_m) const {
  const double signal_s_m = network_.lanes[lane].signal_s_m;
  double cost =
      signal_s_m >= from_s_m && signal_s_m >= 0.0 && signal_s_m < to_s_m ? prices().signal : 0.0;
  if (options_.cost == RouteCost::distance) return cost + (to_s_m - from_s_m);
  double s_m = from_s_m;
  for (const SpeedPiece& piece : network_.speeds.of(lane)) {
    if (piece.to_s_m <= s_m) continue;
    const double end_m = std::min(piece.to_s_m, to_s_m);
    if (end_m > s_m) cost += (end_m - s_m) / speed_mps(lane, piece);
    s_m = std::max(s_m, end_m);
  }
  return cost;
}

double RoutingCostModel::station_within(std::uint32_t lane, double from_s_m, double cost) const {
  double low_m = from_s_m, high_m = network_.lanes[lane].length_m;
  if (travel_cost(lane, from_s_m, high_m) <= cost) return high_m;
  for (int i = 0; i < kBisections; ++i) {
    const double middle_m = 0.5 * (low_m + high_m);
    (travel_cost(lane, from_s_m, middle_m) <= cost ? low_m : high_m) = middle_m;
  }
  return low_m;
}

double RoutingCostModel::turn_cost(std::uint32_t lane) const {
  switch (network_.lanes[lane].turn) {
    case Turn::left:
      return prices().left_turn;
    case Turn::right:
      return prices().right_turn;
    case Turn::u_turn:
      return prices().u_turn;
    default:
      return 0.0;
  }
}

// Parts of the lane group beside which none of the lanes is blocked that are changed to and from.
std::vector<FractionRange> RoutingCostModel::free_ranges(std::span<const std::uint32_t> chain,
                                                         FractionRange range) const {
  std::vector<FractionRange> between;
  for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
    const auto blocked = blocked_of(chain[i], range);
    between.insert(between.end(), blocked.begin(), blocked.end());
  }
  std::ranges::sort(between, {}, &FractionRange::from);
  std::vector<FractionRange> free;
  double from = range.from;
  for (const FractionRange& part : between) {
    if (part.from > from) free.push_back({from, part.from});
    from = std::max(from, part.to);
  }
  if (from < range.to) free.push_back({from, range.to});
  return free;
}

// The first lane is left before what is blocked of it, the last one entered behind.
ChangeBounds RoutingCostModel::bounds_of(std::span<const std::uint32_t> chain, FractionRange range,
                                         const FractionRange& free) const {
  ChangeBounds bounds{.all = free};
  for (const FractionRange& part : blocked_of(chain.front(), range)) {
    bounds.first_to = std::min(bounds.first_to, part.from);
  }
  for (const FractionRange& part : blocked_of(chain.back(), range)) {
    bounds.last_from = std::max(bounds.last_from, part.to);
  }
  return bounds;
}

// Each change as early as its windows and the one before allow.
bool RoutingCostModel::place(std::span<const std::uint32_t> chain, const ChangeBounds& bounds,
                             double room_m, std::vector<FractionRange>* placed) const {
  double fraction = bounds.all.from;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const FractionRange range = bounds.of(i, chain.size() - 1);
    const double length_m = network_.lanes[chain[i]].length_m;
    const double needed = (room_m - kRounding_m) / length_m;
    bool fits = false;
    for (const map::StationRange& window : windows_to(network_, chain[i], chain[i + 1])) {
      const double from = std::max({fraction, range.from, window.from_s_m / length_m});
      if (from + needed > std::min(range.to, window.to_s_m / length_m)) continue;
      fits = true;
      fraction = std::min(range.to, from + room_m / length_m);
      if (placed != nullptr) placed->push_back({from, fraction});
      break;
    }
    if (!fits) return false;
  }
  return true;
}

std::optional<ChangePlan> RoutingCostModel::plan_changes(std::span<const std::uint32_t> chain,
                                                         FractionRange range) const {
  for (std::size_t i = 1; i < chain.size(); ++i) {
    if (!may_enter(chain[i])) return {};
  }
  if (chain.size() < 2) {
    const bool is_free = chain.empty() || !is_blocked(chain.front(), range);
    return is_free ? std::optional(ChangePlan{}) : std::nullopt;
  }
  if (blocked_.empty()) return plan_within(chain, {.all = range});
  std::optional<ChangePlan> best;
  for (const FractionRange& free : free_ranges(chain, range)) {
    auto plan = plan_within(chain, bounds_of(chain, range, free));
    if (plan && (!best || plan->room_m > best->room_m)) best = std::move(plan);
  }
  return best;
}

std::optional<ChangePlan> RoutingCostModel::plan_within(std::span<const std::uint32_t> chain,
                                                        const ChangeBounds& bounds) const {
  if (chain.size() == 2) return plan_change(chain[0], chain[1], bounds);
  double high_m = std::numeric_limits<double>::infinity();
  for (const std::uint32_t lane : chain.first(chain.size() - 1)) {
    high_m = std::min(high_m, (bounds.all.to - bounds.all.from) * network_.lanes[lane].length_m);
  }
  double low_m = least_room_m();
  if (!place(chain, bounds, low_m, nullptr)) return {};
  high_m = std::max(low_m, high_m / static_cast<double>(chain.size() - 1));
  if (!place(chain, bounds, high_m, nullptr)) {
    for (int i = 0; i < kBisections && high_m - low_m > 1e-6; ++i) {
      const double middle_m = 0.5 * (low_m + high_m);
      (place(chain, bounds, middle_m, nullptr) ? low_m : high_m) = middle_m;
    }
  } else {
    low_m = high_m;
  }
  ChangePlan plan;
  plan.room_m = low_m;
  place(chain, bounds, low_m, &plan.ranges);
  return plan;
}

std::optional<ChangePlan> RoutingCostModel::plan_change(std::uint32_t from, std::uint32_t to,
                                                        const ChangeBounds& bounds) const {
  const double length_m = network_.lanes[from].length_m;
  const FractionRange range = bounds.of(0, 1);
  ChangePlan plan;
  for (const map::StationRange& window : windows_to(network_, from, to)) {
    const double first_m = std::max(range.from * length_m, window.from_s_m);
    const double last_m = std::min(range.to * length_m, window.to_s_m);
    if (last_m - first_m <= plan.room_m) continue;
    plan.room_m = last_m - first_m;
    plan.ranges = {{first_m / length_m, last_m / length_m}};
  }
  if (plan.ranges.empty() || plan.room_m < least_room_m() - kRounding_m) return {};
  return plan;
}

double RoutingCostModel::least_room_m() const {
  return relaxed_.length ? 1e-6 : std::max(kLeastRoom_m, options_.least_lane_change_m);
}

double RoutingCostModel::change_cost(std::size_t changes, double room_m) const {
  if (changes == 0) return 0.0;
  const double tightness = std::max(1.0, options_.comfortable_lane_change_m / room_m);
  return static_cast<double>(changes) * prices().lane_change * tightness;
}

std::span<const map::StationRange> windows_to(const RouteNetwork& network, std::uint32_t lane,
                                              std::uint32_t beside) {
  return network.lanes[lane].left == beside ? network.left_windows.of(lane)
                                            : network.right_windows.of(lane);
}

std::vector<std::vector<std::uint32_t>> chains_from(const RouteNetwork& network,
                                                    std::uint32_t from) {
  std::vector<std::vector<std::uint32_t>> chains{{from}};
  extend(network, {from}, &NetworkLane::left, chains);
  extend(network, {from}, &NetworkLane::right, chains);
  return chains;
}

std::vector<std::uint32_t> chain_between(const RouteNetwork& network, std::uint32_t from,
                                         std::uint32_t to) {
  if (from == to) return {from};
  for (const auto side : {&NetworkLane::left, &NetworkLane::right}) {
    std::vector<std::uint32_t> chain{from};
    while (chain.size() <= kMostLaneChanges) {
      const std::uint32_t next = network.lanes[chain.back()].*side;
      if (next == kNoLane || std::find(chain.begin(), chain.end(), next) != chain.end()) break;
      chain.push_back(next);
      if (next == to) return chain;
    }
  }
  return {};
}

}  // namespace roadbed::planning::route
