#pragma once

#include "roadbed/map/lanelet2/write/autoware/written_map.h"
#include "roadbed/map/lanelet2/write/lanelet_map.h"

namespace roadbed::map::lanelet2 {

/// Crosswalks of other formats are objects with an outline: each becomes a lanelet from one side of
/// the road to the other, as wide as its outline's box.
///
///          left border                the road ║
///     ●────────────────────▶●                  ║
///     ┊   way to walk       ┊          ════════╬════════ one to walk
///     ●────────────────────▶●                  ║
///          right border
void add_crosswalk_lanelets(const RoadMap& road_map, LaneletMap& made);

/// A regulatory element for each crosswalk without one, named by the roads that meet it.
void add_crosswalk_regulations(const WrittenMap& written, LaneletMap& made);

}  // namespace roadbed::map::lanelet2
