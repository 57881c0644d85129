#include "roadbed/tools/simulation/candidate_grid.h"

#include <algorithm>

namespace roadbed::tools::inline simulation {
namespace {

using planning::Candidate;

std::optional<Candidate> runner_up_of(const planning::Plan& plan) {
  std::optional<Candidate> best;
  for (const Candidate& candidate : plan.candidates) {
    if (candidate.rejection != planning::Rejection::none) continue;
    if (plan.chosen && candidate.end_d_m == plan.chosen->end_d_m) continue;
    if (!best || candidate.cost < best->cost) best = candidate;
  }
  return best;
}

}  // namespace

std::optional<CandidateGrid> candidate_grid(const planning::Plan& plan, std::size_t row_stride) {
  if (plan.candidates.empty()) return std::nullopt;
  CandidateGrid grid{.end_d_m = {}, .end_l_m = {}, .causes = {}, .runner_up = runner_up_of(plan)};
  const double first_l_m = plan.candidates.front().end_l_m;
  for (const Candidate& candidate : plan.candidates) {
    if (candidate.end_l_m != first_l_m) break;
    grid.end_d_m.push_back(candidate.end_d_m);
  }
  const std::size_t lanes = grid.end_d_m.size();
  for (std::size_t row = 0; row * lanes < plan.candidates.size(); row += row_stride) {
    grid.end_l_m.push_back(plan.candidates[row * lanes].end_l_m);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      grid.causes.push_back(
          static_cast<std::uint8_t>(plan.candidates[row * lanes + lane].rejection));
    }
  }
  return grid;
}

}  // namespace roadbed::tools
