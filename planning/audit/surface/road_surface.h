#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "roadbed/geometry/motion/region_edges.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/polygons/ring.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline audit {

/// What a drive has to stay on.
struct SurfaceRule {
  /// What it is made of.
  enum class Kind {
    drivable,  ///< drivable lanes and road areas of the map
    surface,   ///< these, and shoulders, stops, parking, bus and taxi lanes: all a car may touch
    lanes,     ///< lanes that the drive is along in their direction, and those beside them
    route,     ///< lanes that are named
    area,      ///< polygons
  };
  Kind kind = Kind::drivable;
  const map::RoadMap* road_map = nullptr;  ///< may be null for an area only
  std::vector<map::LaneId> route = {};
  std::vector<geometry::Polygon> area_in_source = {};
  /// Real maps do not meet exactly: points of the map this near to each other, and to an edge, are
  /// one, and holes are closed whose mean width, twice the area over the perimeter, is less. Slits
  /// narrower than this are no holes, nor are round holes up to 2.5 times as wide.
  double seam_m = 0.01;
};
std::string_view to_string(SurfaceRule::Kind kind);

/// Distances to the surface's edge are told up to here; beyond, that it is farther.
inline constexpr double kSurfaceHorizon_m = 20.0;

/// The polygons of a rule that are within the horizon of a drive, one by one as the map has them,
/// in source coordinates; of an area and a route all, whatever the drive. Where roads lie above one
/// another, those on the drive's level (`drive_level.h`).
/// @param reach_m  from the rear axle to the farthest point of the body.
/// @throws InputError if the map has nothing of that kind anywhere.
std::vector<geometry::Polygon> surface_polygons(const SurfaceRule& rule,
                                                const geometry::Trajectory& drive_in_source,
                                                double reach_m);

/// What a drive has to stay on, as one region.
struct RoadSurface {
  std::vector<geometry::Polygon> polygons_in_source;
  geometry::RegionEdges edges;
  /// No edge is farther than this from where the map has it: what closing seams moved. Edges of
  /// holes that were closed are not there.
  double off_by_m = 0.0;
};

/// The union of polygons, seams closed.
/// @throws InputError where they cross each other without end.
RoadSurface road_surface(const std::vector<geometry::Polygon>& polygons_in_source, double seam_m);

}  // namespace roadbed::planning::audit
