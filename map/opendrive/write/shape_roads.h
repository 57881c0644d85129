#pragma once

#include <vector>

#include "roadbed/map/opendrive/write/road_shape.h"

namespace roadbed::map::opendrive {

struct ShapedRoads {
  RoadPlan plan;
  std::vector<RoadShape> shapes;  ///< by planned road
};

/// Which lanes are a road, and its shape. Where one is not sound, the lines across its ends are
/// chosen anew, each as the one with the least faults of all roads that share it; where that does
/// not help, each of its lanes has a road of its own, and is left out where even that cannot be.
/// @param minor    of the revision 1.4 to 1.8.
/// @param threads  what comes of it is the same for any number.
ShapedRoads shape_roads(const RoadMap& road_map, int minor, int threads);

}  // namespace roadbed::map::opendrive
