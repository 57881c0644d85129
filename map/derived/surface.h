#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "roadbed/geometry/polygons/medial_axis.h"
#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// Roads of real files do not meet exactly; points this near are taken as one in surfaces.
/// Lane borders are never moved.
struct SurfaceOptions {
  double weld_m = 1e-3;
};

/// A surface, and what the welding moved to make it one. Its polygons are simple, the outer rings
/// counter-clockwise, holes clockwise, their insides apart.
struct Surface {
  std::vector<geometry::Polygon> polygons;
  std::size_t moved_points = 0;  ///< of outlines of lanes
  double most_moved_m = 0.0;     ///< at most the weld distance
};

/// Area covered by lanes. Neighbours that share a border are joined along it before the exact
/// union, which makes that five times faster. O((N + K) log N) for N vertices, K crossings.
Surface lanes_surface(const RoadMap& road_map, std::span<const LaneId> lanes,
                      const SurfaceOptions& options = {});

/// Union of any polygons, in coordinates of the map.
/// @throws InputError where they cross each other without end.
Surface surface_of(std::span<const geometry::Polygon> polygons, const SurfaceOptions& options = {});

/// Drivable lanes of the whole map, and those of a junction's connecting roads, in order of id.
std::vector<LaneId> drivable_lanes(const RoadMap& road_map);
std::vector<LaneId> drivable_lanes(const RoadMap& road_map, JunctionId junction);

/// Area covered by all lanes of one road.
std::vector<geometry::Polygon> road_surface(const RoadMap& road_map, RoadId road,
                                            const SurfaceOptions& options = {});

/// Area covered by the drivable lanes of a junction's connecting roads.
std::vector<geometry::Polygon> junction_surface(const RoadMap& road_map, JunctionId junction,
                                                const SurfaceOptions& options = {});

/// Area of all drivable lanes of the map.
std::vector<geometry::Polygon> drivable_surface(const RoadMap& road_map,
                                                const SurfaceOptions& options = {});

/// Area of all road areas of the map (`Area::is_road`), areas that touch joined.
std::vector<geometry::Polygon> road_area_surface(const RoadMap& road_map,
                                                 const SurfaceOptions& options = {});

/// Lines in the middle of the map's road areas, with the width along them: the medial axis of
/// `road_area_surface`, without branches that only lead into a corner. Made anew at each call; in
/// order of their first point. O(N log N).
std::vector<geometry::MedialBranch> road_centrelines(const RoadMap& road_map,
                                                     const SurfaceOptions& options = {});

}  // namespace roadbed::map::derived
