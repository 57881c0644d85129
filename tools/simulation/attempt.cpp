#include "roadbed/tools/simulation/attempt.h"

#include <cmath>

namespace roadbed::tools {
namespace {

constexpr double kBearable_mps = 0.3;  // beyond what a bend allows

}  // namespace

double beside_m(const Attempt& attempt) {
  return attempt.proposal ? std::abs(attempt.proposal->plan.chosen->end_d_m) : 0.0;
}

bool is_drivable(const Attempt& attempt) {
  return attempt.answer.is_free && attempt.answer.bend_excess_mps <= kBearable_mps;
}

bool is_good(const Attempt& attempt) { return is_drivable(attempt) && !attempt.answer.misses_goal; }

bool is_better(const Attempt& a, const Attempt& b) {
  if (a.answer.is_free != b.answer.is_free) return a.answer.is_free;
  if (a.answer.is_free) return a.cost < b.cost;
  if (a.answer.free_until_s != b.answer.free_until_s) {
    return a.answer.free_until_s > b.answer.free_until_s;
  }
  return a.answer.plan.back().speed_mps < b.answer.plan.back().speed_mps;
}

}  // namespace roadbed::tools
