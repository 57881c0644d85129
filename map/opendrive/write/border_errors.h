#pragma once

#include <vector>

#include "roadbed/map/opendrive/write/road_shape.h"

namespace roadbed::map::opendrive {

/// Of each planned road how far it is from the map in plan: the largest distance of its borders, as
/// they are written, to the nearest border of the map, or of its lanes' borders to the nearest
/// written one, so that ends which are missing show.
/// @param shapes  of the planned roads.
std::vector<double> border_errors_m(const RoadMap& road_map, const RoadPlan& plan,
                                    const std::vector<RoadShape>& shapes);

}  // namespace roadbed::map::opendrive
