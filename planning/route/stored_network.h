#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "roadbed/planning/route/route_network.h"

namespace roadbed::planning::inline route {

/// A network as bytes: what `import` puts into a compiled map as its routing section, so that a
/// route is found without touching lanes that it does not use. Layout: README.md.
std::string write_route_network(const RouteNetwork& network);

/// None if the bytes are empty or of another version.
/// @throws std::invalid_argument if they are damaged, or not of so many lanes.
std::optional<RouteNetwork> read_route_network(std::string_view bytes, std::size_t lanes);

/// The network of a map: the one in its compiled form, else made now.
/// @throws InputError if the compiled map is damaged.
RouteNetwork route_network_of(const map::RoadMap& road_map);

}  // namespace roadbed::planning::route
