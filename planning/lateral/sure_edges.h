#pragma once

#include "roadbed/planning/lateral/batch_sample.h"
#include "roadbed/planning/lateral/candidate_evaluator.h"

namespace roadbed::planning::inline lateral {

/// End offsets of a batch for which the whole body surely is inside the corridor at a station of
/// it: a closed form that is short by some centimetres. Beyond them the body has to be looked at.
///
/// In the station's tangent frame a corner is at (X, Y), Y ≤ d + X₀ sin θ + w/2 with X₀ the front
/// or minus the rear overhang, and the line at y = κ X²/2 there for some κ of the line nearby. The
/// corner is at most
/// Y − y beside the line, and sin θ ≤ max(0, B/A) of eq. F, so that every bound is linear in d_e.
/// @param asked  the end offsets that are asked for.
OffsetInterval surely_inside(const CandidateEvaluator& evaluator, const Station& station,
                             const LinearPoint& at, const OffsetRange& asked);

}  // namespace roadbed::planning::lateral
