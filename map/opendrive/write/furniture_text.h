#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "roadbed/map/opendrive/write/road_network.h"
#include "roadbed/map/opendrive/write/road_plan.h"
#include "roadbed/map/opendrive/write/road_shape.h"

namespace roadbed::map::opendrive {

/// What stands beside each part of a road, as XML.
struct FurnitureText {
  std::vector<std::string> signals, objects;  ///< children of <signals>, <objects>; by part
  std::string controllers;
  std::size_t lost_signals = 0, lost_objects = 0, lost_stop_lines = 0;  ///< near no road
};

/// Signals with the lanes that they speak to, stop lines, crosswalks and other objects with their
/// outlines, and controllers. A thing stands beside the road of the first lane that it speaks to,
/// else beside the nearest road within 100 m; where it is not beside that road but before or behind
/// it, a signal says its place in the map, too.
FurnitureText furniture_text(const RoadMap& road_map, const RoadPlan& plan,
                             const std::vector<RoadShape>& shapes, const RoadNetwork& network,
                             int minor);

}  // namespace roadbed::map::opendrive
