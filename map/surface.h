#pragma once

#include <vector>

#include "roadbed/geometry/polygon.h"
#include "roadbed/map/road_map.h"

namespace roadbed::map {

/// Roads of real files do not meet exactly; points this near are taken as one in surfaces.
/// Lane borders are never moved.
struct SurfaceOptions {
  double weld_m = 1e-3;
};

/// Area covered by all lanes of one road.
std::vector<geometry::Polygon> road_surface(const RoadMap& road_map, RoadId road,
                                            const SurfaceOptions& options = {});

/// Area covered by the drivable lanes of a junction's connecting roads.
std::vector<geometry::Polygon> junction_surface(const RoadMap& road_map, JunctionId junction,
                                                const SurfaceOptions& options = {});

/// Area of all drivable lanes of the map.
std::vector<geometry::Polygon> drivable_surface(const RoadMap& road_map,
                                                const SurfaceOptions& options = {});

}  // namespace roadbed::map
