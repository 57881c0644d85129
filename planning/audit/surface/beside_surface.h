#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

#include "roadbed/geometry/motion/region_edges.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline audit {

/// What is where a surface is not.
struct BesideSurface {
  enum class Kind {
    unmapped,       ///< the map says nothing, far and wide
    gap,            ///< the map says nothing, but the surface goes on within 3 m: a hole in it
    oncoming_lane,  ///< a drivable lane that runs against the vehicle
    lane,           ///< another drivable lane, or one of taxis and buses
    shoulder,       ///< shoulder, stop
    verge,          ///< border, median, curb, none: between the road and what is beside it
    parking,
    pavement,  ///< sidewalk
    cycle_path,
    other,  ///< any other lane, or an area
  };
  Kind kind = Kind::unmapped;
  std::string name = {};  ///< of the lane or area; empty: none
  std::string type = {};  ///< the source's word for it
};
std::string_view to_string(BesideSurface::Kind kind);

/// "pavement, lane 12/0/3 (sidewalk)".
std::string text_of(const BesideSurface& beside);

/// What is at a point that is not on a surface.
/// @param road_map           null: nobody knows.
/// @param edge_in_source     of the surface, the one nearest to the point.
BesideSurface what_is_beside(const map::RoadMap* road_map, const geometry::RegionEdges& edges,
                             const Eigen::Vector2d& point_in_source,
                             const Eigen::Vector2d& edge_in_source, double heading_rad);

}  // namespace roadbed::planning::audit
