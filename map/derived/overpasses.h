#pragma once

#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// How many roads are stacked below a lane where most are: 0 on the ground, 1 on a bridge over
/// another road. All lanes of a road are on one level, so that a picture can be drawn level by
/// level. One number per lane; two lanes are stacked where they overlap further apart in height
/// than `headroom_m`. O((N + K) log N) for N vertices and K pairs of pieces that meet.
std::vector<int> levels_of_lanes(const RoadMap& road_map, double headroom_m = 2.5);

}  // namespace roadbed::map::derived
