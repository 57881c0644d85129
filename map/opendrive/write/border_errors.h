#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadbed/map/opendrive/write/road_shape.h"

namespace roadbed::map::opendrive {

/// How far a road is from the map, and where, in the map's frame.
struct BorderError {
  double largest_m = 0.0;
  Eigen::Vector2d at{0, 0};
};

/// Of each planned road how far it is from the map in plan: the largest distance of its borders, as
/// they are written, to the nearest border of the map, or of its lanes' borders to the nearest
/// written one, so that ends which are missing show.
/// @param shapes  of the planned roads.
std::vector<BorderError> border_errors(const RoadMap& road_map, const RoadPlan& plan,
                                       const std::vector<RoadShape>& shapes, int threads);

}  // namespace roadbed::map::opendrive
