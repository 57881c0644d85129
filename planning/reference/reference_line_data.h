#pragma once

#include <string>
#include <vector>

#include "roadbed/geometry/curves/fit_curve.h"
#include "roadbed/geometry/curves/smooth_curve.h"
#include "roadbed/planning/reference/reference_point.h"

namespace roadbed::planning::inline reference {

struct ReferenceLineOptions;

/// What a reference line is made of. The line's station 0 is `start_m` of the curve.
struct ReferenceLineData {
  geometry::SmoothCurve curve;
  double start_m = 0.0;
  double goal_s_m = 0.0;
  double largest_move_m = 0.0;
  double corridor_step_m = 1.0;
  std::vector<std::string> notes;
  std::vector<Corridor> corridor;  ///< at stations 0, step, 2 · step, …; not empty
};

/// How a reference line is fitted.
geometry::FitOptions fit_options(const ReferenceLineOptions& options);

}  // namespace roadbed::planning::reference
