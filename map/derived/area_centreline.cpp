#include "roadbed/map/derived/area_centreline.h"

#include <iterator>
#include <utility>

namespace roadbed::map::inline derived {

std::vector<geometry::Polygon> road_area_surface(const RoadMap& road_map,
                                                 const SurfaceOptions& options) {
  std::vector<geometry::Polygon> polygons;
  for (const Area& area : road_map.areas()) {
    if (area.is_road) polygons.insert(polygons.end(), area.in_map.begin(), area.in_map.end());
  }
  return geometry::unite(polygons, options.weld_m);
}

std::vector<geometry::MedialBranch> road_centrelines(const RoadMap& road_map,
                                                     const SurfaceOptions& options) {
  std::vector<geometry::MedialBranch> branches;
  for (const geometry::Polygon& polygon : road_area_surface(road_map, options)) {
    auto found = geometry::medial_axis(polygon);
    branches.insert(branches.end(), std::make_move_iterator(found.begin()),
                    std::make_move_iterator(found.end()));
  }
  return branches;
}

}  // namespace roadbed::map::derived
