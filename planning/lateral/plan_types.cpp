#include "roadbed/planning/lateral/plan_types.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace roadbed::planning::inline lateral {

LateralState Plan::lateral_at(double s_m) const {
  const double l_m = s_m - start.s_m;
  if (l_m >= quintic->length()) return {.s_m = s_m, .d_m = chosen->end_d_m};
  const auto d = quintic->at(l_m);
  return {.s_m = s_m, .d_m = d[0], .d_slope = d[1], .d_curvature_per_m = d[2]};
}

bool Plan::meets_something() const {
  return rejected[static_cast<std::size_t>(Rejection::collision)] > 0;
}

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
  demand(options.completion_horizon_s >= 0.0, "completion_horizon must not be negative");
  demand(options.completion_deceleration_mps2 > 0.0, "completion_deceleration must be positive");
  check_weights(options.weights);
  check(margins_of(options));
}

void check(const SafetyMargins& margins) {
  if (!(margins.clearance_m >= 0.0)) {
    throw std::invalid_argument("plan: the clearance must not be negative");
  }
  if (!std::isfinite(margins.border_margin_m)) {
    throw std::invalid_argument("plan: the border margin must be finite");
  }
}

}  // namespace roadbed::planning::lateral
