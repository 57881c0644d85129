#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/gis/layer.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline gis {

/// Names of all layers, in the order in which they are drawn, the ground first: `areas`,
/// `area_centrelines`, `roads`, `junctions`, `drivable_surface`, `lanes`, `borders`, `centrelines`,
/// `objects`, `object_points`, `stop_lines`, `signals`, `findings`.
std::vector<std::string> layer_names();

/// One layer of a map, `in_map` coordinates.
/// @throws std::invalid_argument if there is no layer of that name.
Layer make_layer(const RoadMap& road_map, std::string_view name);

/// The named layers, or all if none is named, without those that would be empty and not named.
std::vector<Layer> make_layers(const RoadMap& road_map, std::span<const std::string> names = {});

}  // namespace roadbed::map::gis
