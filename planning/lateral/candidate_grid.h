#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/planning/lateral/candidate_evaluator.h"
#include "roadbed/planning/lateral/candidate_search.h"

namespace roadbed::planning::inline lateral {

/// What became of each candidate of a planning cycle, small enough to be kept for every cycle.
struct CandidateGrid {
  std::vector<double> end_d_m, end_l_m;  ///< ascending
  std::vector<std::uint8_t> causes;      ///< the first Rejection of each candidate, d fastest
  /// The cheapest feasible one of them that ends at another offset than the chosen one.
  std::optional<Candidate> runner_up;
};

/// Which candidates of a cycle are kept.
struct KeptCandidates {
  OffsetIndexRange offsets;
  std::size_t length_stride = 5;  ///< of the lengths, only every so many-th
};

/// Judges those that are kept as Plan::candidates are judged, for much less work: where all
/// candidates of some neighbouring offsets surely keep to the road, and clear of everything, none
/// is looked at by itself (sure_edges.h, candidate_fan.h).
/// @param chosen_d_m  where the chosen one ends; none: nothing is feasible.
CandidateGrid judge_grid(CandidateEvaluator& evaluator, const KeptCandidates& kept,
                         std::optional<double> chosen_d_m);

}  // namespace roadbed::planning::lateral
