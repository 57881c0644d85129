#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/planning/travel_rules.h"

namespace roadbed::planning {

/// A lane change that is longer than one passage: it begins in one and ends in a following one,
/// while both lanes stay neighbours across the section ends between.
///
///     from  ────────┬──╮────┬──────
///     to    ────────┴──╰────┴──────
///              start_s_m … end_s_m
struct ChangeSpan {
  struct Beside {
    std::uint32_t from = 0, to = 0;
  };
  std::vector<Beside> lanes;  ///< of each passage in turn, at least two
  double start_s_m = 0.0;     ///< of the first lane that is left: where the change may begin
  double end_s_m = 0.0;       ///< of the last one: where it has to have ended
};

/// Length that the change has, along the lanes that are left [m].
double room_m(const RouteNetwork& network, const ChangeSpan& span);

/// Whether no shorter change behind the first passage has as much room as helps.
bool needs_first(const RouteNetwork& network, const ChangeSpan& span, double enough_m);

/// Changes that begin in a lane behind a station and end in a following passage, for which no
/// change that ends a passage earlier has as much room as helps. At most 64.
std::vector<ChangeSpan> spans_from(const RouteNetwork& network, std::uint32_t lane, double from_s_m,
                                   double enough_m);

/// The window of a lane towards the one beside it that reaches to its end, or from its start.
std::optional<map::StationRange> window_at_end(const RouteNetwork& network, std::uint32_t lane,
                                               std::uint32_t beside);
std::optional<map::StationRange> window_at_start(const RouteNetwork& network, std::uint32_t lane,
                                                 std::uint32_t beside);

/// Whether there is a link from a lane to another one.
bool leads_to(const RouteNetwork& network, std::uint32_t lane, std::uint32_t next);

/// The passage in which the middle of a change lies, and the change as a plan of that passage.
struct SpanPlan {
  std::size_t passage = 0;
  ChangePlan changes;
};

/// None if there is less room than the rules ask for, or a lane may not be entered.
std::optional<SpanPlan> plan_span(const TravelRules& rules, const ChangeSpan& span);

/// Cost of the way from a share of the first passage to a share of the last one: up to the passage
/// of the change along the lanes that are left, from there on along the others.
double cost_of(const TravelRules& rules, const ChangeSpan& span, const SpanPlan& plan,
               ShareRange ends);

/// The same way, passage by passage.
std::vector<Passage> passages_of(const ChangeSpan& span, const SpanPlan& plan, ShareRange ends);

}  // namespace roadbed::planning
