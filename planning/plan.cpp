#include "roadbed/planning/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "roadbed/planning/lateral/candidate_evaluator.h"
#include "roadbed/planning/lateral/candidate_search.h"
#include "roadbed/planning/lateral/feasibility_check.h"
#include "roadbed/planning/lateral/search_by_cost.h"

namespace roadbed::planning {
namespace {

OffsetIndexRange offsets_within(const Grid& grid, const EndOffsetRange& ends) {
  const std::vector<double>& end_d_m = grid.end_d_m();
  const auto first = std::ranges::lower_bound(end_d_m, ends.least_d_m - kLimitSlack);
  const auto end = std::ranges::upper_bound(end_d_m, ends.most_d_m + kLimitSlack);
  if (first >= end) {
    throw std::invalid_argument(fmt::format("plan: the grid has no end between {} m and {} m",
                                            ends.least_d_m, ends.most_d_m));
  }
  return {static_cast<std::size_t>(first - end_d_m.begin()), static_cast<std::size_t>(end - first)};
}

// The first one, cheapest first, that keeps to the road and collides with nothing.
std::optional<std::size_t> cheapest_feasible(CandidateEvaluator& evaluator,
                                             CandidateSearch& search) {
  FeasibilityCheck check(evaluator);
  const auto known = [&](std::size_t index) { return check.known(index); };
  for (auto equals = search.pop_equals(known); !equals.empty(); equals = search.pop_equals(known)) {
    std::ranges::sort(equals, [&](std::size_t a, std::size_t b) {
      return is_preferred(candidate_at(evaluator, search, a), candidate_at(evaluator, search, b));
    });
    for (const std::size_t index : equals) {
      Rejection found = check.known(index);
      if (found == Rejection::none) found = check.at(index);
      search.reject(index, found);
      if (found == Rejection::none) return index;
    }
  }
  return std::nullopt;
}

std::vector<Candidate> all_candidates(CandidateEvaluator& evaluator, CandidateSearch& search) {
  FeasibilityCheck check(evaluator);
  std::vector<Candidate> candidates;
  candidates.reserve(evaluator.grid().size());
  for (std::size_t index = 0; index < evaluator.grid().size(); ++index) {
    const Rejection found = search.rejections()[index];
    if (found == Rejection::none || found == Rejection::collision) {
      search.reject(index, check.at(index));
    }
    candidates.push_back(candidate_with_terms(evaluator, search, index));
  }
  return candidates;
}

RejectionCounts count(const std::vector<Rejection>& rejections) {
  RejectionCounts counts{};
  for (const Rejection rejection : rejections) ++counts[static_cast<std::size_t>(rejection)];
  counts[static_cast<std::size_t>(Rejection::none)] = 0;
  return counts;
}

std::string reason_for_none(const CandidateEvaluator& evaluator, std::size_t candidates,
                            const RejectionCounts& rejected) {
  const auto of = [&](Rejection cause) { return rejected[static_cast<std::size_t>(cause)]; };
  return fmt::format(
      "{}none of {} candidates can be driven: {} leave the road, {} are beyond the curvature that "
      "can be steered, {} are beyond the lateral acceleration, {} are beyond the steering rate, {} "
      "collide",
      evaluator.fault_of_start(), candidates, of(Rejection::off_road),
      of(Rejection::beyond_curvature), of(Rejection::lateral_acceleration),
      of(Rejection::steering_rate), of(Rejection::collision));
}

}  // namespace

struct PlanningCycle::Impl {
  Impl(const PlanInput& input, const geometry::VehicleShape& vehicle, const PlanOptions& by_options)
      : options(by_options),
        evaluator(input, vehicle, options),
        search(search_by_cost(evaluator)) {}

  // What the last question rejected is open again; what was evaluated for it is kept.
  void restart(const SafetyMargins& margins, const OffsetIndexRange& offsets) {
    const bool is_other = margins != evaluator.margins();
    if (is_other) {
      evaluator.set_margins(margins);
      search.set_on_road([this](std::size_t batch) {
        return end_offsets_on_road(evaluator.context(), evaluator.family(batch), options.points);
      });
    }
    if (!is_fresh || is_other || offsets.count != evaluator.grid().offset_count())
      search.restart(offsets);
    is_fresh = false;
  }

  void choose(std::size_t choice, Plan& plan) {
    plan.chosen = candidate_with_terms(evaluator, search, choice);
    plan.quintic = evaluator.quintic(choice);
    plan.trajectory = geometry::Trajectory(evaluator.drive(choice).points);
    plan.rejected = count(search.rejections());
  }

  PlanOptions options;
  CandidateEvaluator evaluator;
  CandidateSearch search;
  bool is_fresh = true;
};

PlanningCycle::PlanningCycle(const PlanInput& input, const geometry::VehicleShape& vehicle,
                             const PlanOptions& options) {
  check(input.start, options);
  impl_ = std::make_unique<Impl>(input, vehicle, options);
}

PlanningCycle::~PlanningCycle() = default;

Plan PlanningCycle::plan(const SafetyMargins& margins, const EndOffsetRange& ends) {
  check(margins);
  CandidateEvaluator& evaluator = impl_->evaluator;
  CandidateSearch& search = impl_->search;
  const OffsetIndexRange offsets = offsets_within(evaluator.grid(), ends);
  impl_->restart(margins, offsets);
  const std::optional<std::size_t> choice = cheapest_feasible(evaluator, search);
  Plan plan;
  plan.start = evaluator.input().start;
  plan.evaluated = search.evaluated();
  if (choice) impl_->choose(*choice, plan);
  if (impl_->options.keep_candidates) plan.candidates = all_candidates(evaluator, search);
  if (!choice) {
    plan.rejected = count(search.rejections());
    plan.reason =
        reason_for_none(evaluator, evaluator.grid().length_count() * offsets.count, plan.rejected);
  }
  return plan;
}

Plan PlanningCycle::plan_and_judge_all(const SafetyMargins& margins,
                                       const EndOffsetRange& ends) const {
  PlanOptions options = impl_->options;
  options.keep_candidates = true;
  Plan plan = PlanningCycle(input(), impl_->evaluator.vehicle(), options).plan(margins, ends);
  const auto is_asked_for = [&](const Candidate& candidate) {
    return candidate.end_d_m >= ends.least_d_m - kLimitSlack &&
           candidate.end_d_m <= ends.most_d_m + kLimitSlack;
  };
  std::erase_if(plan.candidates, std::not_fn(is_asked_for));
  return plan;
}

const PlanInput& PlanningCycle::input() const { return impl_->evaluator.input(); }

CandidateGrid PlanningCycle::judge(const SafetyMargins& margins, const EndOffsetRange& ends,
                                   const Plan& plan, std::size_t length_stride) {
  check(margins);
  CandidateEvaluator& evaluator = impl_->evaluator;
  const OffsetIndexRange offsets = offsets_within(evaluator.grid(), ends);
  impl_->restart(margins, offsets);
  const auto chosen_d_m = plan.chosen ? std::optional(plan.chosen->end_d_m) : std::nullopt;
  return judge_grid(evaluator, {offsets, length_stride}, chosen_d_m);
}

Plan plan_path(const PlanInput& input, const geometry::VehicleShape& vehicle,
               const PlanOptions& options) {
  return PlanningCycle(input, vehicle, options).plan(margins_of(options));
}

}  // namespace roadbed::planning
