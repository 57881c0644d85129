#pragma once

#include "roadbed/map/lanelet2/write/autoware/written_map.h"
#include "roadbed/map/lanelet2/write/lanelet_map.h"

namespace roadbed::map::lanelet2 {

/// What could not be taken from the source, and was assumed.
struct AssumedOfLights {
  std::size_t heights = 0;     ///< of bodies
  std::size_t facings = 0;     ///< the source has them turned away from those they speak to
  std::size_t stop_lines = 0;  ///< before the intersection, else beside the light
};

/// Traffic lights as Autoware asks for them: each with the height of its body, three bulbs and a
/// stop line; named by the roads inside the intersection, behind the stop line.
/// @param road_map  that the lanelets are of; elements of a Lanelet2 map keep their lanelets.
AssumedOfLights complete_traffic_lights(const RoadMap& road_map, const WrittenMap& written,
                                        LaneletMap& made);

}  // namespace roadbed::map::lanelet2
