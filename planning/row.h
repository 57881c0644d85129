#pragma once

#include <vector>

#include "roadbed/planning/candidates.h"
#include "roadbed/planning/cost.h"

namespace roadbed::planning {

/// Cost and verdict of every candidate of one length.
struct RowResult {
  std::vector<double> cost;          ///< one per lane; meaningless where folded or off the road
  std::vector<Rejection> rejection;  ///< as judge() finds it
};

/// What all rows of a cycle are evaluated with.
struct RowQuestion {
  const std::vector<double>& end_d_m;  ///< of the lanes, ascending
  CostTerms weights;
  CostFrame frame;  ///< end_l_m is that of the row
  DrivingLimits limits;
};

/// All candidates of one length at once: the same costs (to rounding) and verdicts as
/// cost_terms() and judge() of each one, with the work at a station shared by all of them.
RowResult evaluate_row(const std::vector<Station>& stations, const QuinticFamily& family,
                       const RowQuestion& question);

}  // namespace roadbed::planning
