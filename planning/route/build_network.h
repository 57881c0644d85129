#pragma once

#include "roadbed/planning/route/route_network.h"

namespace roadbed::planning::inline route {

/// O(points of the map).
RouteNetwork make_route_network(const map::RoadMap& road_map, const NetworkOptions& options = {});

/// Adds to a network of a map's lanes those that may be driven against their direction.
///
///        left            ◀─────── reversed ────        right
///     ───────▶ lane ───▶ ─────── two-way lane ▶ ───▶ lane
///
/// They have the map's links the other way round. Where borders meet head to head or
/// back to back a lane also leads over into one that is driven the other way: ends belong together
/// if both corners are within 5 cm. Lights are for the lane's own direction. O(N log N).
void add_contraflow_lanes(const map::RoadMap& road_map, const NetworkOptions& options,
                          RouteNetwork& network);

/// Finds for each lane of a network those beside it that are driven the same way, and where a
/// change to them is permitted. O(lanes).
void add_neighbours(const map::RoadMap& road_map, const NetworkOptions& options,
                    RouteNetwork& network);

}  // namespace roadbed::planning::route
