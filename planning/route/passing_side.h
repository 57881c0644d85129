#pragma once

#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline route {

/// On which one passes: 1 left, as where one drives on the right, −1 right: there most lanes of the
/// map that have oncoming traffic beside them have it on the right. O(lanes).
double side_to_pass_on(const map::RoadMap& road_map);

}  // namespace roadbed::planning::route
