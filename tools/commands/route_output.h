#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tools/cli/place.h"

namespace roadbed::tools::inline commands {

/// Text of a document; names of sources are not always valid UTF-8, JSON has to be.
std::string text_of(const nlohmann::ordered_json& json, int indent);

/// `{"found":true,"cost_s":…,"length_m":…,"lanes":[…],"instructions":[…],…}`
nlohmann::ordered_json route_json(const map::RoadMap& road_map, const planning::Route& route);

/// `{"found":false,"reason":"…",…}`
nlohmann::ordered_json no_route_json(const map::RoadMap& road_map,
                                     const planning::RouteAnswer& answer);

/// How a place was understood: lane, station, and every lane that it might have been.
nlohmann::ordered_json place_json(const map::RoadMap& road_map, const Place& place);

/// A feature collection: of each route the way as a line, with the members of route_json() as its
/// properties, and the corridor as a multipolygon. In source coordinates; see map::write_geojson
/// for its `crs`.
std::string route_geojson(const map::RoadMap& road_map, const std::vector<planning::Route>& routes);

/// A feature collection of one multipolygon with these properties.
std::string area_geojson(const map::RoadMap& road_map, const std::vector<geometry::Polygon>& area,
                         const nlohmann::ordered_json& properties);

/// A row per leg: route, lane, stations, exit, length and cost.
std::string route_csv(const map::RoadMap& road_map, const std::vector<planning::Route>& routes);

/// A picture of an area in the map around it, with lines drawn over it: ways of routes.
std::string area_svg(const map::RoadMap& road_map, const std::vector<geometry::Polygon>& area,
                     const std::vector<planning::Route>& routes);

/// Lines for a reader: sums, legs, instructions.
std::string route_text(const map::RoadMap& road_map, const planning::Route& route);

/// Of outputs that hold an area, rows or a picture.
inline const std::vector<std::string> kAreaSuffixes = {".geojson", ".json", ".csv", ".svg"};

/// Checks that the suffix of an output names one of the formats.
/// @throws InputError if it does not.
void check_suffix(const std::filesystem::path& output, const std::vector<std::string>& suffixes);

}  // namespace roadbed::tools::commands
