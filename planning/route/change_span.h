#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/planning/route/routing_cost_model.h"

namespace roadbed::planning::inline route {

inline constexpr double kLeastPart_m = 0.1;    ///< of a lane group, to be worth a part of a change
inline constexpr std::size_t kMostSpans = 64;  ///< from one lane, or to one end

/// Lane changes, one or more to the same side, that take more than one lane group: they begin in
/// one and end in a following one, while the lanes stay neighbours across the section ends between.
/// Each has an equal share of the length.
///
///     from  ────────┬──╮────┬──────
///     to    ────────┴──╰────┴──────
///              start_s_m … end_s_m
struct ChangeSpan {
  struct Beside {
    std::uint32_t from = 0, to = 0;
  };
  std::size_t changes = 1;
  std::vector<Beside> lanes;  ///< of each lane group in turn, at least two
  double start_s_m = 0.0;     ///< of the first lane that is left: where the change may begin
  double end_s_m = 0.0;       ///< of the last one: where it has to have ended
};

/// Length that all its changes have, along the first lanes [m].
double room_m(const RouteNetwork& network, const ChangeSpan& span);

/// Whether what is behind the first lane group has less room than helps, and, of several changes,
/// none has as much in the first lane group or the last one alone.
bool needs_first(const RouteNetwork& network, const ChangeSpan& span, double enough_m);

/// Changes that begin in a lane behind a station and end in a following lane group, for which no
/// such that end a lane group earlier have as much room as helps. Up to three of them at once, at
/// most 64.
std::vector<ChangeSpan> spans_from(const RouteNetwork& network, std::uint32_t lane, double from_s_m,
                                   double enough_m);

/// Lanes beside each other, from one that is left to one that is changed to.
using LaneChain = std::vector<std::uint32_t>;

/// What the windows of all changes along a chain have in common that reaches to the end of the
/// lanes, or from their start, by stations of the first.
std::optional<map::StationRange> window_at_end(const RouteNetwork& network, const LaneChain& chain);
std::optional<map::StationRange> window_at_start(const RouteNetwork& network,
                                                 const LaneChain& chain);

/// Whether each lane has a link to the one behind it.
bool lead_to(const RouteNetwork& network, const LaneChain& lanes, const LaneChain& next);

/// So many lanes to a side of one; empty if there are fewer.
LaneChain lanes_beside(const RouteNetwork& network, std::uint32_t lane,
                       std::uint32_t NetworkLane::*side, std::size_t count);

/// The most changes that are laid over section ends together.
inline constexpr std::size_t kMostTogether = 3;

/// How the changes lie in the lane groups.
struct SpanPlan {
  std::vector<std::size_t> made;  ///< changes whose middle lies before the end of each lane group
  std::vector<double> begin_m;    ///< length of the changes before each lane group
  double room_m = 0.0;            ///< that each of them has
};

/// None if there is less room than the rules ask for, or a lane may not be entered or is blocked.
std::optional<SpanPlan> plan_span(const RoutingCostModel& model, const ChangeSpan& span);

/// Cost of the way from a fraction of the first lane group to a fraction of the last one: a lane
/// group costs what the lane does on which it is left.
double cost_of(const RoutingCostModel& model, const ChangeSpan& span, const SpanPlan& plan,
               FractionRange ends);

/// The same way, lane group by lane group.
std::vector<LaneGroup> lane_groups_of(const RouteNetwork& network, const ChangeSpan& span,
                                      const SpanPlan& plan, FractionRange ends);

}  // namespace roadbed::planning::route
