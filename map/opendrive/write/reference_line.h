#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "roadbed/geometry/curves/plan_view.h"

namespace roadbed::map::opendrive {

/// What a reference line follows: a line, whose ends it has, and its headings there.
struct ReferenceTarget {
  std::vector<Eigen::Vector2d> in_map;  ///< two points or more
  double start_heading_rad = 0.0, end_heading_rad = 0.0;
  double step_m = 0.5;  ///< between the points of the line that is sought
};

/// A reference line along a target: of all lines p with its ends and headings the one of least
///
///     ∫ |p − target|² + scale⁴ |p″|² ds,
///
/// cut into the longest clothoids, arcs and lines that stay within `tolerance_m` of p and join each
/// other with one heading. The target itself may be farther: details shorter than the scale are
/// smoothed away. O(N log N).
std::vector<geometry::PlanPiece> fit_reference_line(const ReferenceTarget& target, double scale_m,
                                                    double tolerance_m);

}  // namespace roadbed::map::opendrive
