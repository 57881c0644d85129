#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/planning/route/lane_list.h"
#include "roadbed/planning/route/route_network.h"
#include "roadbed/planning/route/route_options.h"

namespace roadbed::planning::inline route {

/// Which rules a search leaves out, to find out what stands in the way. Markings and one-way lanes
/// are left out of the network itself, see NetworkOptions.
struct RelaxedRules {
  bool closed_lanes = false, participants = false, length = false;
};

/// Part of a lane group, as fractions of the length of each of its lanes.
struct FractionRange {
  double from = 0.0, to = 1.0;
};

/// Where the changes of a lane group are made: one range a change, in order and apart, as
/// fractions. One that takes several lane groups, see ChangeSpan, reaches below 0 or above 1.
struct ChangePlan {
  std::vector<FractionRange> ranges;
  double room_m = 0.0;  ///< that each of them has
};

/// The lanes that one lane group uses, in turn, the part of it that is driven, and its changes.
struct LaneGroup {
  LaneList chain;
  FractionRange range;
  ChangePlan changes;
};

/// Where the changes of a lane group may be made: all of them within a part of it, the first one up
/// to a fraction and the last one from a fraction on.
struct ChangeBounds {
  FractionRange all;
  double first_to = 1.0, last_from = 0.0;

  /// Those of one change among so many.
  FractionRange of(std::size_t change, std::size_t count) const {
    return {change + 1 == count ? std::max(all.from, last_from) : all.from,
            change == 0 ? std::min(all.to, first_to) : all.to};
  }
};

/// The rules and costs of travel over a network, by one measure. Refers to its arguments.
class RoutingCostModel {
 public:
  RoutingCostModel(const RouteNetwork& network, const RouteOptions& options,
                   RelaxedRules relaxed = {});

  const RouteNetwork& network() const { return network_; }
  const RouteOptions& options() const { return options_; }

  bool may_enter(std::uint32_t lane) const { return !closed_[lane] && may_be_used(lane); }
  bool is_closed(std::uint32_t lane) const { return closed_[lane]; }
  bool may_be_used(std::uint32_t lane) const {
    return relaxed_.participants || network_.lanes[lane].users.has(options_.participant);
  }
  void close(std::uint32_t lane, bool closed = true) { closed_[lane] = closed; }

  /// Whether a part of the lane, as fractions of its length, is not free to be driven through.
  bool is_blocked(std::uint32_t lane, FractionRange part) const;

  /// Speed on a piece of a lane: the least of limit, bend and vehicle [m/s].
  double speed_mps(std::uint32_t lane, const SpeedPiece& piece) const;

  /// Cost of driving between two stations of a lane, with the light that stands there.
  double travel_cost(std::uint32_t lane, double from_s_m, double to_s_m) const;

  /// The station of a lane that is reached from another one at no more than that cost.
  double station_within(std::uint32_t lane, double from_s_m, double cost) const;

  /// What the turn costs that the lane is.
  double turn_cost(std::uint32_t lane) const;

  /// Room for changes along a chain of neighbours, from its first to its last, within a part of
  /// the lane group: as much for each of them as all can have. None if one would have less than the
  /// least length, a lane may not be entered, or what is driven of one is blocked.
  std::optional<ChangePlan> plan_changes(std::span<const std::uint32_t> chain,
                                         FractionRange range) const;

  /// The length that each change has to have at least.
  double least_room_m() const;

  /// The length from which on more of it helps no more.
  double enough_room_m() const { return planning::enough_room_m(options_); }

  /// What so many changes cost, each of which has that room.
  double change_cost(std::size_t changes, double room_m) const;

 private:
  const ManoeuvrePrices& prices() const {
    return options_.cost == RouteCost::time ? options_.prices_s : options_.prices_m;
  }
  double sum_of_pieces(std::uint32_t lane, double from_s_m, double to_s_m) const;
  std::vector<FractionRange> blocked_of(std::uint32_t lane, FractionRange part) const;
  std::vector<FractionRange> free_ranges(std::span<const std::uint32_t> chain,
                                         FractionRange range) const;
  ChangeBounds bounds_of(std::span<const std::uint32_t> chain, FractionRange range,
                         const FractionRange& free) const;
  std::optional<ChangePlan> plan_within(std::span<const std::uint32_t> chain,
                                        const ChangeBounds& bounds) const;
  std::optional<ChangePlan> plan_change(std::uint32_t from, std::uint32_t to,
                                        const ChangeBounds& bounds) const;
  bool place(std::span<const std::uint32_t> chain, const ChangeBounds& bounds, double room_m,
             std::vector<FractionRange>* placed) const;

  const RouteNetwork& network_;
  const RouteOptions& options_;
  RelaxedRules relaxed_;
  std::vector<bool> closed_;
  struct BlockedPart {
    std::uint32_t lane;
    FractionRange part;
  };
  std::vector<BlockedPart> blocked_;
  std::vector<double> whole_cost_;  ///< travel_cost() of whole lanes
};

/// Where a lane may be left to the one beside it, by its stations.
std::span<const map::StationRange> windows_to(const RouteNetwork& network, std::uint32_t lane,
                                              std::uint32_t beside);

/// Lanes of one lane group that a route changes over at most: more than any road has beside each
/// other, so that lanes in a section do not cost by the square of their number.
inline constexpr std::size_t kMostLaneChanges = 64;

/// The chain of neighbours that leads from one lane of a lane group to another; empty if none does
/// within kMostLaneChanges.
std::vector<std::uint32_t> chain_between(const RouteNetwork& network, std::uint32_t from,
                                         std::uint32_t to);

/// Lanes of the lane group that can be changed to from one: chains to each of them, itself first,
/// kMostLaneChanges to each side at most.
std::vector<std::vector<std::uint32_t>> chains_from(const RouteNetwork& network,
                                                    std::uint32_t from);

}  // namespace roadbed::planning::route
