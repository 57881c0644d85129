#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/route.h"
#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

// From the map's frame to what the report shows, in source coordinates.

/// What of a map may lie in the box (map::map_part).
std::shared_ptr<const map::RoadMap> map_around(const map::RoadMap& road_map,
                                               const Eigen::AlignedBox2d& box_in_source);

LineInSource line_in_source(const map::RoadMap& road_map, const geometry::Polyline& in_map);

/// The ring between a lane's borders.
LineInSource outline_in_source(const map::RoadMap& road_map, const map::Lane& lane);

/// Centrelines of the route's legs, from where each is entered to where it is left.
std::vector<LineInSource> route_lines(const map::RoadMap& road_map, const planning::Route& route);

/// Where the route ends.
std::optional<Eigen::Vector2d> route_goal(const map::RoadMap& road_map,
                                          const planning::Route& route);

/// Points of the reference line, one a metre.
LineInSource reference_points(const map::RoadMap& road_map, const planning::ReferenceLine& line);

/// Occupied space of a height band in plan view, as few boxes: cells of one row that touch are one
/// box, and so are equal boxes of rows that touch. Only what meets `box_in_source`. The boxes cover
/// exactly what the cells cover; they may overlap where cells have different sizes.
std::vector<map::Box2> occupied_in(const map::OccupancySource& occupancy,
                                   const map::HeightBand& band,
                                   const Eigen::AlignedBox2d& box_in_source);

/// The same from boxes of any kind.
std::vector<map::Box2> joined(std::vector<map::Box2> boxes);

}  // namespace roadbed::tools::report
