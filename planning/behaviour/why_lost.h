#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/planning/behaviour/cruise_law.h"
#include "roadbed/planning/behaviour/hypothesis_outcome.h"
#include "roadbed/planning/behaviour/maneuver_hypothesis.h"
#include "roadbed/planning/obstacles/traffic.h"

namespace roadbed::planning::inline behaviour {

/// Maneuvers past somebody that no path was asked for, as those who decide on them advise against
/// it.
std::vector<HypothesisOutcome> not_asked_for(const PassingDecision& passing);

/// A path was asked for, and there is none.
HypothesisOutcome without_path(const ManeuverHypothesis& hypothesis);

/// Of those that were judged, why each is worse than the best.
std::vector<HypothesisOutcome> outcomes_of(const std::vector<ManeuverHypothesis>& judged,
                                           std::size_t best, const Traffic& traffic);

}  // namespace roadbed::planning::behaviour
