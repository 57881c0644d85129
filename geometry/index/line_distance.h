#pragma once

#include <Eigen/Core>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/primitives/polyline.h"

namespace roadbed::geometry::inline index {

/// Distances of many points to one line, each in O(log N) on average where `Polyline::project`
/// looks at all N segments. Refers to the line.
class LineDistance {
 public:
  explicit LineDistance(const Polyline& line);

  /// Distance of a point to the nearest place of the line [m].
  double operator()(const Eigen::Vector2d& point) const;

 private:
  double to_run_m(std::size_t run, const Eigen::Vector2d& point) const;

  const Polyline& line_;
  BoxTree runs_;  ///< boxes of so many segments one behind the other; none of a short line
};

/// The greatest distance of a line's vertices to another line [m].
double farthest_m(const Polyline& from, const Polyline& to);

}  // namespace roadbed::geometry::index
