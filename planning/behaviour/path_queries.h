#pragma once

#include <vector>

#include "roadbed/planning/behaviour/cruise_law.h"
#include "roadbed/planning/behaviour/maneuver_hypothesis.h"

namespace roadbed::planning::inline behaviour {

/// Offsets of the lane's own, as far as those who decide on the lanes beside it leave them.
LateralReplanner::Offsets offsets_in_lane(const PassingDecision& passing);

/// On the way to a place: past those whom `passing` names, and, last, along the lane, within what
/// it allows. Paths past others are planned at the speed of the free road.
std::vector<PathQuery> queries_on_route(GoalLine& on, const LateralReplanner::Question& question,
                                        const PassingDecision& passing);

/// To a goal in time: near a goal that lies beside the line, through it; and, last, any way.
std::vector<PathQuery> queries_to_goal(GoalLine& on, const LateralReplanner::Question& question);

/// Ends to the right and left of the line, within its lane and a little beyond.
std::vector<PathQuery> queries_beside(GoalLine& on, const LateralReplanner::Question& question);

/// Ends on the lanes beside.
std::vector<PathQuery> queries_in_other_lanes(GoalLine& on,
                                              const LateralReplanner::Question& question);

}  // namespace roadbed::planning::behaviour
