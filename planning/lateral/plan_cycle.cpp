#include "roadbed/planning/lateral/plan_cycle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "roadbed/planning/lateral/candidate_search.h"
#include "roadbed/planning/lateral/closer_look.h"
#include "roadbed/planning/lateral/cycle.h"
#include "roadbed/planning/lateral/row.h"

namespace roadbed::planning::inline lateral {
namespace {

void check(const LateralState& start, const PlanOptions& options) {
  const auto demand = [](bool kept, const char* rule) {
    if (!kept) throw std::invalid_argument(fmt::format("plan: {}", rule));
  };
  demand(std::isfinite(start.s_m) && std::isfinite(start.d_m) && std::isfinite(start.d_slope) &&
             std::isfinite(start.d_curvature_per_m),
         "the start must be finite");
  demand(options.points >= 2, "a candidate needs at least 2 points");
  demand(options.max_lateral_acceleration_mps2 > 0.0, "max_lateral_acceleration must be positive");
  demand(options.recovery_m > 0.0, "recovery_m must be positive");
  demand(options.horizon_s >= 0.0, "the horizon must not be negative");
  demand(options.way_on_horizon_s >= 0.0, "way_on_horizon must not be negative");
  demand(options.way_on_deceleration_mps2 > 0.0, "way_on_deceleration must be positive");
  check_weights(options.weights);
}

void check(const Room& room) {
  if (!(room.clearance_m >= 0.0)) {
    throw std::invalid_argument("plan: the clearance must not be negative");
  }
  if (!std::isfinite(room.border_margin_m)) {
    throw std::invalid_argument("plan: the border margin must be finite");
  }
}

RowQuestion question_of(const Cycle& cycle) {
  const PlanOptions& options = cycle.options();
  RowQuestion question{
      .end_d_m = cycle.grid().end_d_m(),
      .weights = options.weights,
      .frame = {},
      .limits = driving_limits(cycle.vehicle(), options.max_lateral_acceleration_mps2)};
  if (options.limit_steering_rate) {
    question.limits.max_steering_rate_radps = cycle.vehicle().max_steering_rate_radps;
  }
  return question;
}

bool evaluates_all(const PlanOptions& options) {
  return options.exhaustive || options.keep_candidates;
}

// What rows refer to, in one block. Rows that are evaluated at once share their points, which then
// stay in the fastest cache.
std::unique_ptr<KernelPoint[]> kernel_points(const Cycle& cycle) {
  const auto count = static_cast<std::size_t>(cycle.options().points);
  const std::size_t rows = evaluates_all(cycle.options()) ? 1 : cycle.grid().rows();
  return std::make_unique_for_overwrite<KernelPoint[]>(rows * count);
}

// The cost of their length is the same for all candidates of a row, and no other term is negative.
std::vector<double> least_costs(const Cycle& cycle) {
  std::vector<double> costs;
  for (std::size_t row = 0; row < cycle.grid().rows(); ++row) {
    costs.push_back((1.0 - 1e-9) * of(cycle.options().weights, CostTerm::length) *
                    length_term(cycle.frame(row)));
  }
  return costs;
}

CandidateSearch search_of(const Cycle& cycle, KernelPoint* points) {
  const auto make_row = [&cycle, points, question = question_of(cycle)](std::size_t row) mutable {
    const auto count = static_cast<std::size_t>(cycle.options().points);
    const std::size_t first = evaluates_all(cycle.options()) ? 0 : row * count;
    question.frame = cycle.frame(row);
    return Row(cycle.make_stations(row), cycle.family(row), question,
               std::span(points + first, count));
  };
  return {cycle.grid().lanes(), least_costs(cycle), make_row, evaluates_all(cycle.options())};
}

Candidate candidate_at(const Cycle& cycle, const CandidateSearch& search, std::size_t index) {
  return {.end_d_m = cycle.grid().end_d_m(index),
          .end_l_m = cycle.grid().end_l_m(index),
          .terms = {},
          .cost = search.cost(index),
          .rejection = search.rejections()[index]};
}

Candidate candidate_with_terms(Cycle& cycle, const CandidateSearch& search, std::size_t index) {
  Candidate candidate = candidate_at(cycle, search, index);
  const std::size_t row = index / cycle.grid().lanes();
  const auto points = cost_points(cycle.stations(row), cycle.quintic(index));
  if (!points.empty()) candidate.terms = cost_terms(points, cycle.frame(row));
  return candidate;
}

// The first one, cheapest first, that keeps to the road and collides with nothing.
std::optional<std::size_t> choose_lazily(Cycle& cycle, CandidateSearch& search) {
  CloserLook look(cycle);
  const auto known = [&](std::size_t index) { return look.known(index); };
  for (auto equals = search.pop_equals(known); !equals.empty(); equals = search.pop_equals(known)) {
    std::ranges::sort(equals, [&](std::size_t a, std::size_t b) {
      return is_preferred(candidate_at(cycle, search, a), candidate_at(cycle, search, b));
    });
    for (const std::size_t index : equals) {
      Rejection found = look.known(index);
      if (found == Rejection::none) found = look.at(index);
      search.reject(index, found);
      if (found == Rejection::none) return index;
    }
  }
  return std::nullopt;
}

std::vector<Candidate> all_candidates(Cycle& cycle, CandidateSearch& search) {
  CloserLook look(cycle);
  std::vector<Candidate> candidates;
  candidates.reserve(cycle.grid().size());
  for (std::size_t index = 0; index < cycle.grid().size(); ++index) {
    const Rejection found = search.rejections()[index];
    if (found == Rejection::none || found == Rejection::collision) {
      search.reject(index, look.at(index));
    }
    candidates.push_back(candidate_with_terms(cycle, search, index));
  }
  return candidates;
}

RejectionCounts count(const std::vector<Rejection>& rejections) {
  RejectionCounts counts{};
  for (const Rejection rejection : rejections) ++counts[static_cast<std::size_t>(rejection)];
  counts[static_cast<std::size_t>(Rejection::none)] = 0;
  return counts;
}

LaneRange lanes_in(const Grid& grid, const EndRange& ends) {
  const std::vector<double>& end_d_m = grid.end_d_m();
  const auto first = std::ranges::lower_bound(end_d_m, ends.least_d_m - kLimitSlack);
  const auto end = std::ranges::upper_bound(end_d_m, ends.most_d_m + kLimitSlack);
  if (first >= end) {
    throw std::invalid_argument(fmt::format("plan: the grid has no end between {} m and {} m",
                                            ends.least_d_m, ends.most_d_m));
  }
  return {static_cast<std::size_t>(first - end_d_m.begin()), static_cast<std::size_t>(end - first)};
}

// What is wrong with the start, that none of the candidates can help.
std::string fault_of_start(const Cycle& cycle) {
  const Corridor room = cycle.input().line.corridor_at(cycle.input().start.s_m);
  const double width_m = room.left_m + room.right_m;
  if (cycle.vehicle().width_m > width_m) {
    return fmt::format(
        "the vehicle is {:.2f} m wide and the road {:.2f} m: ", cycle.vehicle().width_m, width_m);
  }
  if (cycle.course().start_excess_m > 0.0) {
    return fmt::format("the start is {:.2f} m off the road: ", cycle.course().start_excess_m);
  }
  return {};
}

std::string reason_for_none(const Cycle& cycle, std::size_t candidates,
                            const RejectionCounts& rejected) {
  const auto of = [&](Rejection cause) { return rejected[static_cast<std::size_t>(cause)]; };
  return fmt::format(
      "{}none of {} candidates can be driven: {} leave the road, {} are beyond the curvature that "
      "can be steered, {} are beyond the lateral acceleration, {} are beyond the steering rate, {} "
      "collide",
      fault_of_start(cycle), candidates, of(Rejection::off_road), of(Rejection::beyond_curvature),
      of(Rejection::lateral_acceleration), of(Rejection::steering_rate), of(Rejection::collision));
}

}  // namespace

struct PlanCycle::Impl {
  Impl(const PlanInput& input, const geometry::VehicleShape& vehicle, const PlanOptions& by_options)
      : options(by_options),
        cycle(input, vehicle, options),
        points(kernel_points(cycle)),
        search(search_of(cycle, points.get())) {}

  void move_to(const Room& room, const LaneRange& lanes) {
    const bool is_other = room != cycle.room();
    if (is_other) {
      cycle.set_room(room);
      search.set_on_road([this](std::size_t row) {
        return lanes_on_road(cycle.course(), cycle.family(row), options.points);
      });
    }
    if (!is_fresh || is_other || lanes.count != cycle.grid().lanes()) search.restart(lanes);
    is_fresh = false;
  }

  PlanOptions options;
  Cycle cycle;
  std::unique_ptr<KernelPoint[]> points;
  CandidateSearch search;
  bool is_fresh = true;
};

PlanCycle::PlanCycle(const PlanInput& input, const geometry::VehicleShape& vehicle,
                     const PlanOptions& options) {
  check(input.start, options);
  check(room_of(options));
  impl_ = std::make_unique<Impl>(input, vehicle, options);
}

PlanCycle::~PlanCycle() = default;

Plan PlanCycle::plan(const Room& room, const EndRange& ends) {
  check(room);
  const LaneRange lanes = lanes_in(impl_->cycle.grid(), ends);
  impl_->move_to(room, lanes);
  Cycle& cycle = impl_->cycle;
  CandidateSearch& search = impl_->search;
  const std::optional<std::size_t> choice = choose_lazily(cycle, search);
  Plan plan;
  plan.evaluated = search.evaluated();
  plan.start = cycle.input().start;
  if (choice) {
    plan.chosen = candidate_with_terms(cycle, search, *choice);
    plan.quintic = cycle.quintic(*choice);
    plan.trajectory = geometry::Trajectory(cycle.drive(*choice).points);
    plan.rejected = count(search.rejections());
  }
  if (impl_->options.keep_candidates) plan.candidates = all_candidates(cycle, search);
  if (!choice) {
    plan.rejected = count(search.rejections());
    plan.reason = reason_for_none(cycle, cycle.grid().rows() * lanes.count, plan.rejected);
  }
  return plan;
}

bool is_in_the_way(const Plan& plan) {
  return plan.rejected[static_cast<std::size_t>(Rejection::collision)] > 0;
}

std::vector<Plan> plan_in_rooms(PlanCycle& cycle, std::span<const Room> rooms) {
  std::vector<Plan> plans;
  for (const Room& room : rooms) {
    plans.push_back(cycle.plan(room));
    if (plans.back().chosen || is_in_the_way(plans.back())) break;
  }
  return plans;
}

}  // namespace roadbed::planning::lateral
