#pragma once

#include <Eigen/Core>
#include <vector>

namespace roadbed::geometry::inline polygons {

/// A closed ring of points, the last one not repeated.
using Ring = std::vector<Eigen::Vector2d>;

/// A region with holes: the outer ring counter-clockwise, holes clockwise, all simple.
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
};

}  // namespace roadbed::geometry::polygons
