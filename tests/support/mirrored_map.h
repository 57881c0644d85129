#pragma once

#include "roadbed/map/model/road_map.h"

namespace roadbed::tests {

/// The map of these parts seen in a mirror, y turned over: right-hand traffic is left-hand traffic.
map::RoadMap mirrored(map::RoadMapParts parts);

}  // namespace roadbed::tests
