#pragma once

#include <Eigen/Geometry>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/commonroad/scenario.h"

namespace roadbed::planning::inline obstacles {

/// A rectangle of CommonRoad, in the frame that it is given in.
geometry::Rectangle rectangle_of(const map::commonroad::RectangleShape& shape);

/// The least box around all parts of a shape; empty for a shape without any.
Eigen::AlignedBox2d bounds_of(const map::commonroad::Shape& shape);

}  // namespace roadbed::planning::obstacles
