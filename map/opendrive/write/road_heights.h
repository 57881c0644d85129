#pragma once

#include <vector>

#include "roadbed/geometry/curves/piecewise_cubic.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/opendrive/document.h"
#include "roadbed/map/opendrive/write/placed_road.h"
#include "roadbed/map/opendrive/write/reference_table.h"
#include "roadbed/map/opendrive/write/road_plan.h"

namespace roadbed::map::opendrive {

/// Heights of a road as OpenDRIVE has them.
struct RoadHeights {
  /// At each station the straight line across the borders of all lanes that one drives on.
  geometry::PiecewiseCubic elevation, superelevation;
  /// Of each section's lanes, from left to right: how far they lie above that plane.
  std::vector<std::vector<std::vector<LaneHeight>>> lanes;
  double error_m = 0.0;  ///< largest of a border's height
};

/// @param reference  of the placed road.
RoadHeights fit_heights(const RoadMap& road_map, const PlannedRoad& road, const PlacedRoad& placed,
                        const ReferenceTable& reference);

}  // namespace roadbed::map::opendrive
