#pragma once

#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/planning/lateral/plan_types.h"

namespace roadbed::tests {

/// One candidate, evaluated by plain arithmetic on power series in long double, from the paper's
/// definitions alone: an oracle that shares no formula with the planner.
struct SlowCandidate {
  bool folded = false;  ///< 1 − κ d ≤ 0.05 somewhere
  planning::CostTerms terms{};
  double cost = 0.0;
  double worst_curvature_per_m = 0.0;
  double worst_lateral_mps2 = 0.0;
  double worst_steering_radps = 0.0;  ///< rate of the default vehicle's steering angle
  double least_d_m = 0.0, most_d_m = 0.0;

  /// Poses and times at the candidate's points, and on at d_e over the longest candidate.
  std::vector<geometry::TrajectoryPoint> drive;
  std::vector<double> drive_s_m;  ///< stations of the drive's points
};

SlowCandidate slow_candidate(const planning::PlanInput& input, const planning::PlanOptions& options,
                             double longest_l_m, double end_d_m, double end_l_m);

}  // namespace roadbed::tests
