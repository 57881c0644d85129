#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/planning/lateral/plan.h"

namespace roadbed::tools::inline simulation {

/// What became of each candidate of a planning cycle, small enough to be kept for every cycle.
struct CandidateGrid {
  std::vector<double> end_d_m, end_l_m;  ///< ascending
  std::vector<std::uint8_t> causes;      ///< planning::Rejection per candidate, d fastest
  /// The cheapest feasible candidate that ends at another offset than the chosen one.
  std::optional<planning::Candidate> runner_up;
};

/// @param row_stride  of the lengths, only every so many-th is kept.
/// None if the plan kept no candidates.
std::optional<CandidateGrid> candidate_grid(const planning::Plan& plan, std::size_t row_stride = 3);

}  // namespace roadbed::tools
