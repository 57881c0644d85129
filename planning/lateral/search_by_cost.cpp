#include "roadbed/planning/lateral/search_by_cost.h"

#include <memory>
#include <span>
#include <vector>

#include "roadbed/planning/lateral/candidate_batch.h"

namespace roadbed::planning::inline lateral {
namespace {

bool evaluates_all(const PlanOptions& options) {
  return options.exhaustive || options.keep_candidates;
}

// What batches refer to, in one block. Batches that are evaluated at once share their points, which
// then stay in the fastest cache.
std::shared_ptr<KernelPoint[]> kernel_points(const CandidateEvaluator& evaluator) {
  const auto count = static_cast<std::size_t>(evaluator.options().points);
  const std::size_t batches =
      evaluates_all(evaluator.options()) ? 1 : evaluator.grid().length_count();
  return std::make_unique_for_overwrite<KernelPoint[]>(batches * count);
}

// The cost of their length is the same for all candidates of a batch, and no other term is
// negative.
std::vector<double> least_costs(const CandidateEvaluator& evaluator) {
  std::vector<double> costs;
  for (std::size_t batch = 0; batch < evaluator.grid().length_count(); ++batch) {
    costs.push_back((1.0 - 1e-9) * of(evaluator.options().weights, CostTerm::length) *
                    length_term(evaluator.frame(batch)));
  }
  return costs;
}

}  // namespace

BatchConfig batch_config(const CandidateEvaluator& evaluator) {
  const PlanOptions& options = evaluator.options();
  BatchConfig config{
      .end_d_m = evaluator.grid().end_d_m(),
      .weights = options.weights,
      .frame = {},
      .limits = driving_limits(evaluator.vehicle(), options.max_lateral_acceleration_mps2)};
  if (options.limit_steering_rate) {
    config.limits.max_steering_rate_radps = evaluator.vehicle().max_steering_rate_radps;
  }
  return config;
}

CandidateSearch search_by_cost(CandidateEvaluator& evaluator) {
  const bool all = evaluates_all(evaluator.options());
  const auto make_batch = [&evaluator, all, points = kernel_points(evaluator),
                           config = batch_config(evaluator)](std::size_t batch) mutable {
    const auto count = static_cast<std::size_t>(evaluator.options().points);
    const std::size_t first = all ? 0 : batch * count;
    config.frame = evaluator.frame(batch);
    const std::span<KernelPoint> own_points(points.get() + first, count);
    const QuinticFamily& family = evaluator.family(batch);
    return evaluator.options().keep_stations
               ? CandidateBatch(evaluator.stations(batch), family, config, own_points)
               : CandidateBatch(evaluator.make_stations(batch), family, config, own_points);
  };
  return {evaluator.grid().offset_count(), least_costs(evaluator), make_batch, all};
}

Candidate candidate_at(const CandidateEvaluator& evaluator, const CandidateSearch& search,
                       std::size_t index) {
  return {.end_d_m = evaluator.grid().end_d_m(index),
          .end_l_m = evaluator.grid().end_l_m(index),
          .terms = {},
          .cost = search.cost(index),
          .rejection = search.rejections()[index]};
}

CostTerms terms_of(CandidateEvaluator& evaluator, std::size_t index) {
  const std::size_t batch = index / evaluator.grid().offset_count();
  const auto points = cost_points(evaluator.stations(batch), evaluator.quintic(index));
  return points.empty() ? CostTerms{} : cost_terms(points, evaluator.frame(batch));
}

Candidate candidate_with_terms(CandidateEvaluator& evaluator, const CandidateSearch& search,
                               std::size_t index) {
  Candidate candidate = candidate_at(evaluator, search, index);
  candidate.terms = terms_of(evaluator, index);
  return candidate;
}

}  // namespace roadbed::planning::lateral
