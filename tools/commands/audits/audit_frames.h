#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"

namespace roadbed::tools::inline commands::inline audits {

/// Drivable lanes of a map that meet a box, and some beside it perhaps, as rings in source
/// coordinates.
std::vector<geometry::Ring> drivable_rings(const map::RoadMap& road_map, const map::Box2& around);

/// Box around all lanes of a map; none if there are none.
std::optional<map::Box2> road_bounds(const map::RoadMap& road_map);

/// Box around all measured space in plan view; none if nothing was measured.
std::optional<map::Box2> measured_bounds(const map::OccupancySource& occupancy);

/// Whether they meet; touching counts.
bool overlap(const map::Box2& a, const map::Box2& b);

/// "x 0.0 to 10.0, y -5.0 to 5.0".
std::string text_of(const map::Box2& box);

/// An occupancy apart from the roads of a map cannot be meant.
/// @param roads      bounds of the map's.
/// @param measured   of the occupancy.
/// @param occupancy  the name of its file.
/// @throws InputError if both have an extent and the two do not meet.
void check_overlap(const std::optional<map::Box2>& roads, const std::optional<map::Box2>& measured,
                   const std::string& occupancy);

/// Occupied cells of a height band in plan view, as they are; they may lie above one another. Those
/// that meet `around`, and some beside it perhaps.
std::vector<map::Box2> occupied_boxes(const map::OccupancySource& occupancy,
                                      const map::HeightBand& band, const map::Box2& around);

}  // namespace roadbed::tools::commands::audits
