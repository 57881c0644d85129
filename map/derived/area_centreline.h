#pragma once

#include <vector>

#include "roadbed/geometry/polygons/medial_axis.h"
#include "roadbed/map/derived/surface.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// Area of all road areas of the map (`Area::is_road`), areas that touch joined.
std::vector<geometry::Polygon> road_area_surface(const RoadMap& road_map,
                                                 const SurfaceOptions& options = {});

/// Lines in the middle of the map's road areas, with the width along them: the medial axis of
/// `road_area_surface`, without branches that only lead into a corner. Made anew at each call; in
/// order of their first point. O(N log N).
std::vector<geometry::MedialBranch> road_centrelines(const RoadMap& road_map,
                                                     const SurfaceOptions& options = {});

}  // namespace roadbed::map::derived
