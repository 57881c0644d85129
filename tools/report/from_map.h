#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/route.h"
#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

// From the map's frame to what the report shows, in source coordinates.

/// Lanes of which a part may lie in the box, in the map's order.
std::vector<ReportLane> lanes_in(const map::RoadMap& road_map,
                                 const Eigen::AlignedBox2d& box_in_source);

/// Centrelines of the route's legs, from where each is entered to where it is left.
std::vector<LineInSource> route_lines(const map::RoadMap& road_map, const planning::Route& route);

/// Where the route ends.
std::optional<Eigen::Vector2d> route_goal(const map::RoadMap& road_map,
                                          const planning::Route& route);

/// Points of the reference line, one a metre.
LineInSource reference_points(const map::RoadMap& road_map, const planning::ReferenceLine& line);

}  // namespace roadbed::tools::report
