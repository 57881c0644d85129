#pragma once

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline reference {

/// Station at which the road along a line ends [m]: past its goal the line follows the lanes, and
/// where these end it is led on straight, over no road. Gaps between lanes of less than 0.6 m, as
/// files have them, are no end. `length_m()` where the road goes on as far as the line.
double road_end_s_m(const ReferenceLine& line, const map::RoadMap& road_map);

}  // namespace roadbed::planning::reference
