#pragma once

#include <Eigen/Core>
#include <span>

#include "roadbed/geometry/motion/rectangle.h"

namespace roadbed::map::inline occupancy::inline objects {

/// The rectangle along the sides of a body of which a sensor sees one or two: of all rectangles
/// around the points, turned by whole degrees, the one to whose sides most of them are close
/// (closeness criterion of [Zhang, Xu, Dong, Dolan 2017, doi:10.1109/IVS.2017.7995698], points
/// nearer than 0.1 m count as on a side, of points in one square of 0.1 m the first). It holds all
/// points; its length is the longer side; its axis points to the right half-plane.
///
///        ┌───────────┐
///        │           :   the area of the box that is seen at a corner would be least for
///        └╴╴╴╴╴╴╴╴╴╴╴┘   a rectangle along the diagonal
///
/// @param points  one at least.
geometry::Rectangle fitted_rectangle(std::span<const Eigen::Vector2d> points);

/// The least rectangle along `axis`, a unit vector, around all points.
geometry::Rectangle rectangle_along(const Eigen::Vector2d& axis,
                                    std::span<const Eigen::Vector2d> points);

}  // namespace roadbed::map::occupancy::objects
