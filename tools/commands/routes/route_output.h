#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tools/cli/arguments.h"
#include "roadbed/tools/cli/place.h"

namespace roadbed::tools::inline commands::inline routes {

/// Text of a document; names of sources are not always valid UTF-8, JSON has to be.
std::string text_of(const nlohmann::ordered_json& json, int indent);

/// How answers say where something is.
enum class Coordinates {
  source,   ///< the map's raw ones, in metres
  lon_lat,  ///< those, and longitude and latitude; GeoJSON in these alone
};

/// The option `--lonlat`.
void declare_lon_lat(Arguments& arguments, bool& wants_lon_lat);

/// Longitude and latitude of a place on a lane's centreline, in degrees.
/// @throws InputError where the map's system is unknown or PROJ is not there.
Eigen::Vector2d lon_lat_of(const map::RoadMap& road_map, map::LaneId lane, double s_m);

/// Adds `from_lon_deg`, `from_lat_deg`, `to_lon_deg`, `to_lat_deg` of a stretch of a lane. Throws
/// as above.
void add_lon_lat(const map::RoadMap& road_map, map::LaneId lane, double from_s_m, double to_s_m,
                 nlohmann::ordered_json& json);

/// The same as fields of CSV, each with a comma before it, below the first.
inline constexpr const char* kLonLatColumns = ",from_lon_deg,from_lat_deg,to_lon_deg,to_lat_deg";
std::string lon_lat_fields(const map::RoadMap& road_map, map::LaneId lane, double from_s_m,
                           double to_s_m);

/// `{"found":true,"cost_s":…,"length_m":…,"lanes":[…],"instructions":[…],…}`
nlohmann::ordered_json route_json(const map::RoadMap& road_map, const planning::Route& route,
                                  Coordinates coordinates = Coordinates::source);

/// `{"found":false,"reason":"…",…}`
nlohmann::ordered_json no_route_json(const map::RoadMap& road_map,
                                     const planning::RouteAnswer& answer);

/// How a place was understood: lane, station, and every lane that it might have been.
nlohmann::ordered_json place_json(const map::RoadMap& road_map, const Place& place);

/// A feature collection: of each route the way as a line, with the members of route_json() as its
/// properties, and the corridor as a multipolygon. See map::write_geojson for the `crs` of source
/// coordinates.
std::string route_geojson(const map::RoadMap& road_map, const std::vector<planning::Route>& routes,
                          Coordinates coordinates);

/// A feature collection of one multipolygon with these properties.
std::string area_geojson(const map::RoadMap& road_map, const std::vector<geometry::Polygon>& area,
                         const nlohmann::ordered_json& properties, Coordinates coordinates);

/// A row per leg: route, lane, stations, exit, length and cost.
std::string route_csv(const map::RoadMap& road_map, const std::vector<planning::Route>& routes,
                      Coordinates coordinates);

/// A picture of an area in the map around it, with lines drawn over it: ways of routes.
std::string area_svg(const map::RoadMap& road_map, const std::vector<geometry::Polygon>& area,
                     const std::vector<planning::Route>& routes);

/// Lines for a reader: sums, legs, instructions.
std::string route_text(const map::RoadMap& road_map, const planning::Route& route);

/// Of outputs that hold an area, rows or a picture.
inline const std::vector<std::string> kAreaSuffixes = {".geojson", ".json", ".csv", ".svg"};

/// Checks that the suffix of an output, of its name or what `--format` says, names one of the
/// formats.
/// @throws InputError if it does not.
void check_suffix(const std::filesystem::path& output, const std::string& suffix,
                  const std::vector<std::string>& suffixes);

}  // namespace roadbed::tools::commands::routes
