#include "roadbed/planning/behaviour/why_lost.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

namespace roadbed::planning::inline behaviour {
namespace {

/// Who blocks the place at which a drive is no longer free; none: nobody is found there.
std::optional<std::size_t> met(const ManeuverHypothesis& hypothesis) {
  if (hypothesis.by_cruise_law && hypothesis.meeting) return hypothesis.meeting->obstacle;
  const SpeedSearchAnswer& answer = hypothesis.answer;
  if (!hypothesis.occupancy) return std::nullopt;
  for (const SpeedState& state : answer.plan) {
    const int step = static_cast<int>(std::lround(state.t_s / StGraph::kStep_s));
    for (const StInterval& part : hypothesis.occupancy->at(step)) {
      const bool is_in = state.ahead_m > part.from_m && state.ahead_m < part.to_m;
      if (is_in && part.obstacle != StInterval::kNoObstacle) return part.obstacle;
    }
  }
  return std::nullopt;
}

std::string whom_it_meets(const ManeuverHypothesis& hypothesis, const Traffic& traffic) {
  const std::optional<std::size_t> obstacle = met(hypothesis);
  if (!obstacle || *obstacle >= traffic.obstacles.size()) return "something";
  const Obstacle& other = traffic.obstacles[*obstacle];
  return other.id.empty() ? other.kind : fmt::format("{} {}", other.kind, other.id);
}

/// In the order in which is_better() compares.
std::string why_worse(const ManeuverHypothesis& lost, const ManeuverHypothesis& best,
                      const Traffic& traffic) {
  const SpeedSearchAnswer& answer = lost.answer;
  if (!answer.is_free) {
    return fmt::format("meets {} after {:.1f} s", whom_it_meets(lost, traffic),
                       answer.free_until_s);
  }
  if (!is_drivable(lost)) {
    return fmt::format("takes a bend {:.1f} m/s too fast{}", answer.bend_excess_mps,
                       answer.misses_goal ? ", and misses the goal" : "");
  }
  if (answer.misses_goal && !best.answer.misses_goal) return "misses the goal";
  return fmt::format("costs {:.3f}, the one that is driven {:.3f}", lost.cost, best.cost);
}

HypothesisOutcome outcome_of(const ManeuverHypothesis& hypothesis) {
  HypothesisOutcome outcome{.maneuver = hypothesis.maneuver};
  if (const std::optional<Candidate>& chosen = hypothesis.proposal.plan.chosen) {
    outcome.end_d_m = chosen->end_d_m;
    outcome.end_l_m = chosen->end_l_m;
    if (!hypothesis.proposal.knots) outcome.path_cost = chosen->cost;
  }
  if (hypothesis.risk_level && !hypothesis.by_cruise_law) outcome.drive_cost = hypothesis.cost;
  if (hypothesis.occupancy) {
    outcome.st = st_picture(*hypothesis.occupancy, hypothesis.answer.plan);
  }
  return outcome;
}

}  // namespace

std::vector<HypothesisOutcome> not_asked_for(const PassingDecision& passing) {
  std::vector<HypothesisOutcome> outcomes;
  const auto add = [&](Maneuver maneuver, bool is_asked_for, const std::string& reason) {
    if (is_asked_for || reason.empty()) return;
    outcomes.push_back({.maneuver = maneuver, .reason = reason});
  };
  add(Maneuver::overtake, passing.overtaking.overtaken.has_value(), passing.overtaking.reason);
  add(Maneuver::pass_in_lane, passing.in_lane.offset_m.has_value(), passing.in_lane.reason);
  add(Maneuver::pass_within_lane, passing.within_lane.passed.has_value(),
      passing.within_lane.reason);
  return outcomes;
}

HypothesisOutcome without_path(const ManeuverHypothesis& hypothesis) {
  HypothesisOutcome outcome = outcome_of(hypothesis);
  outcome.reason = hypothesis.proposal.plan.reason;
  return outcome;
}

std::vector<HypothesisOutcome> outcomes_of(const std::vector<ManeuverHypothesis>& judged,
                                           std::size_t best, const Traffic& traffic) {
  std::vector<HypothesisOutcome> outcomes;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    outcomes.push_back(outcome_of(judged[i]));
    outcomes.back().is_driven = i == best;
    if (i != best) outcomes.back().reason = why_worse(judged[i], judged[best], traffic);
  }
  return outcomes;
}

}  // namespace roadbed::planning::behaviour
