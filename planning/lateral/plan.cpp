#include "roadbed/planning/lateral/plan.h"

#include <cmath>

#include "roadbed/planning/lateral/plan_cycle.h"

namespace roadbed::planning::inline lateral {

bool is_preferred(const Candidate& a, const Candidate& b) {
  const double side_a = std::abs(a.end_d_m), side_b = std::abs(b.end_d_m);
  if (side_a != side_b) return side_a < side_b;
  if (a.end_l_m != b.end_l_m) return a.end_l_m > b.end_l_m;
  return a.end_d_m > b.end_d_m;
}

LateralState Plan::lateral_at(double s_m) const {
  const double l_m = s_m - start.s_m;
  if (l_m >= quintic->length()) return {.s_m = s_m, .d_m = chosen->end_d_m};
  const auto d = quintic->at(l_m);
  return {.s_m = s_m, .d_m = d[0], .d_slope = d[1], .d_curvature_per_m = d[2]};
}

Plan plan_path(const PlanInput& input, const geometry::VehicleShape& vehicle,
               const PlanOptions& options) {
  return PlanCycle(input, vehicle, options).plan(room_of(options));
}

}  // namespace roadbed::planning::lateral
