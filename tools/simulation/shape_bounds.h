#pragma once

#include <Eigen/Geometry>

#include "roadbed/geometry/rectangle.h"
#include "roadbed/map/formats/common_road_scenario.h"

namespace roadbed::tools {

/// A rectangle of CommonRoad, in the frame that it is given in.
geometry::Rectangle rectangle_of(const map::common_road::RectangleShape& shape);

/// The least box around all parts of a shape; empty for a shape without any.
Eigen::AlignedBox2d bounds_of(const map::common_road::Shape& shape);

}  // namespace roadbed::tools
