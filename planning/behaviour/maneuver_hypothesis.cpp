#include "roadbed/planning/behaviour/maneuver_hypothesis.h"

#include <cmath>

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kBearable_mps = 0.3;  // beyond what a bend allows

}  // namespace

double beside_m(const ManeuverHypothesis& hypothesis) {
  return hypothesis.proposal ? std::abs(hypothesis.proposal->plan.chosen->end_d_m) : 0.0;
}

bool is_drivable(const ManeuverHypothesis& hypothesis) {
  return hypothesis.answer.is_free && hypothesis.answer.bend_excess_mps <= kBearable_mps;
}

bool is_good(const ManeuverHypothesis& hypothesis) {
  return is_drivable(hypothesis) && !hypothesis.answer.misses_goal;
}

bool is_better(const ManeuverHypothesis& a, const ManeuverHypothesis& b) {
  if (a.answer.is_free != b.answer.is_free) return a.answer.is_free;
  if (a.answer.is_free) return a.cost < b.cost;
  if (a.answer.free_until_s != b.answer.free_until_s) {
    return a.answer.free_until_s > b.answer.free_until_s;
  }
  return a.answer.plan.back().speed_mps < b.answer.plan.back().speed_mps;
}

}  // namespace roadbed::planning::behaviour
