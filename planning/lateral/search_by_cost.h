#pragma once

#include "roadbed/planning/lateral/candidate_evaluator.h"
#include "roadbed/planning/lateral/candidate_search.h"

namespace roadbed::planning::inline lateral {

/// What the batches of a cycle are evaluated with; but for the frame.
BatchConfig batch_config(const CandidateEvaluator& evaluator);

/// A search over all candidates of a cycle by their cost: what the vehicle cannot drive, or what
/// leaves the road with its rear axle, is rejected on the way.
/// @param evaluator  kept by reference.
CandidateSearch search_by_cost(CandidateEvaluator& evaluator);

/// A candidate of the search, with what it costs and why it was rejected so far.
Candidate candidate_at(const CandidateEvaluator& evaluator, const CandidateSearch& search,
                       std::size_t index);

/// Its twelve terms; 0 where it is folded.
CostTerms terms_of(CandidateEvaluator& evaluator, std::size_t index);

/// The same with its twelve terms.
Candidate candidate_with_terms(CandidateEvaluator& evaluator, const CandidateSearch& search,
                               std::size_t index);

}  // namespace roadbed::planning::lateral
