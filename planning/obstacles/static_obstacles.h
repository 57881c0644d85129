#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadbed/geometry/index/point_index.h"
#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline obstacles {

/// The standing ones of a list of obstacles, with distances to them. A KD-tree over points spread
/// on their bodies gives lower bounds; the rectangles give the exact distance.
class StaticObstacles {
 public:
  explicit StaticObstacles(const std::vector<Obstacle>& obstacles);

  bool empty() const { return bodies_.empty(); }

  /// A lower bound of the distance from a point to the nearest body [m]; at most kLargestGap_m
  /// below it unless there are very many or large bodies. O(log N).
  double distance_bound_m(const Eigen::Vector2d& point) const;

  /// Exact distance to the nearest body [m]; infinite if there is none. O(N).
  double distance_m(const geometry::Rectangle& rectangle) const;

  /// The body that is nearest to a rectangle; of equally near ones the first. O(N). @pre not empty
  const geometry::Rectangle& nearest(const geometry::Rectangle& rectangle) const;

  /// Greatest distance from a point of a body to the nearest of the points spread on it.
  static constexpr double kLargestGap_m = 0.25;

 private:
  std::vector<geometry::Rectangle> bodies_;
  double gap_m_ = kLargestGap_m;
  geometry::PointIndex points_{{}};
};

}  // namespace roadbed::planning::obstacles
