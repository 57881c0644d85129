#pragma once

// Private to map/occupancy: a vehicle's rectangle beside the square cells of a grid.

#include <Eigen/Core>

#include "roadbed/geometry/rectangle.h"

namespace roadbed::map {

/// Half the sides of the rectangle's bounding box, along x and y.
Eigen::Vector2d half_extent_m(const geometry::Rectangle& rectangle);

/// Exact distance to an axis-aligned square, 0 on overlap or touch.
double distance_to_square_m(const geometry::Rectangle& rectangle, const Eigen::Vector2d& centre,
                            double half_side_m);

/// Area of the part that lies in an axis-aligned square.
double overlap_with_square_m2(const geometry::Rectangle& rectangle, const Eigen::Vector2d& centre,
                              double half_side_m);

}  // namespace roadbed::map
