#include "roadbed/tools/commands/maps/region_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/geojson/document.h"
#include "roadbed/map/gis/lon_lat.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tools/audit/route_file.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

/// "lane:12/0/-1,500m": the lane's name and the distance; "route:F.json,30m": the route's file.
struct Surroundings {
  std::string lane;
  std::filesystem::path route_file;  // of no lane
  double distance_m = 0.0;
};

std::optional<Surroundings> surroundings_of(std::string_view text) {
  constexpr double kLeast_m = 1e-3, kMost_m = 1e6;
  constexpr std::string_view of_lane = "lane:", of_route = "route:";
  const std::size_t comma = text.rfind(',');
  const bool is_route = text.starts_with(of_route);
  if ((!text.starts_with(of_lane) && !is_route) || comma == text.npos) return {};
  const std::string_view number = text.substr(comma + 1);
  const std::size_t start = is_route ? of_route.size() : of_lane.size();
  const std::string named(text.substr(start, comma - start));
  Surroundings found;
  if (is_route) {
    found.route_file = named;
  } else {
    found.lane = named;
  }
  const char* end = number.data() + number.size();
  const auto [rest, error] = std::from_chars(number.data(), end, found.distance_m);
  const bool fits = error == std::errc() && std::string_view(rest, end) == "m" &&
                    found.distance_m >= kLeast_m && found.distance_m <= kMost_m;
  return fits && !named.empty() ? std::optional(found) : std::nullopt;
}

/// All rings of a file of polygons, as they stand.
std::vector<geometry::Ring> rings_of(const map::geojson::Document& document,
                                     const std::string& name) {
  std::vector<geometry::Ring> rings;
  for (const auto& feature : document.features) {
    for (const auto& polygon : feature.polygons) {
      rings.insert(rings.end(), polygon.rings.begin(), polygon.rings.end());
    }
  }
  std::erase_if(rings, [](const geometry::Ring& ring) { return ring.size() < 3; });
  if (rings.empty()) {
    throw map::InputError({.file = name,
                           .found = "no polygon",
                           .needed = "at least one Polygon or MultiPolygon",
                           .remedy = "give the outline of the part that stays"});
  }
  return rings;
}

std::vector<Eigen::Vector2d> line_of_lane(const std::string& lane, const map::RoadMap& road_map,
                                          const std::string& map_name) {
  if (const auto id = road_map.find_lane(lane)) return road_map.lane(*id).centre.in_map.points();
  throw map::InputError({.file = map_name,
                         .found = fmt::format("no lane {}", lane),
                         .needed = "a lane of the map for --within",
                         .remedy = "see the names with: roadbed locate MAP --at X,Y"});
}

/// The part of a lane's centre that is driven; against the lane from the greater station on.
std::vector<Eigen::Vector2d> driven_part(const geometry::Polyline& centre,
                                         const RouteFileLeg& leg) {
  const auto [least_m, most_m] = std::minmax(leg.from_s_m, leg.to_s_m);
  std::vector<Eigen::Vector2d> part{centre.at(least_m)};
  for (std::size_t i = 0; i < centre.points().size(); ++i) {
    const double s_m = centre.stations_m()[i];
    if (s_m > least_m && s_m < most_m) part.push_back(centre.points()[i]);
  }
  part.push_back(centre.at(most_m));
  if (leg.from_s_m > leg.to_s_m) std::ranges::reverse(part);
  return part;
}

std::vector<Eigen::Vector2d> line_of_route(const std::filesystem::path& file,
                                           const map::RoadMap& road_map) {
  std::vector<Eigen::Vector2d> line;
  for (const RouteFileLeg& leg : read_route_file(file, road_map)) {
    std::ranges::copy(driven_part(road_map.lane(leg.lane).centre.in_map, leg),
                      std::back_inserter(line));
  }
  return line;
}

}  // namespace

void RegionOption::declare(Arguments& arguments, const std::string& what) {
  arguments
      .add("--bbox", box_, "The part inside a box: X0,Y0,X1,Y1 in the " + what + "'s coordinates")
      .values(4)
      .separated_by(',');
  arguments
      .add("--polygon", polygon_file_,
           "The part inside the polygons of a GeoJSON file: longitude and latitude, or the " +
               what + "'s coordinates where its member crs is null or names another system")
      .reads()
      .ending(".geojson");
  arguments
      .add("--within", within_,
           "The part within a distance of a lane, lane:NAME,500m, or of a route that route --json "
           "printed, route:F.json,30m")
      .checked([](const std::string& text) {
        return surroundings_of(text)
                   ? ""
                   : "is not lane:NAME,500m or route:F.json,30m, of 0.001 to 1000000 m";
      })
      .may_read([](const std::string& text) {
        const auto asked = surroundings_of(text);
        return asked ? asked->route_file : std::filesystem::path();
      });
}

int RegionOption::count_given() const {
  return int(!box_.empty()) + int(!polygon_file_.empty()) + int(!within_.empty());
}

std::string RegionOption::fault() const {
  if (count_given() != 1) return "just one of --bbox, --polygon and --within is required";
  if (!box_.empty() && !(box_[0] < box_[2] && box_[1] < box_[3])) {
    return "--bbox: X0 is less than X1, and Y0 less than Y1";
  }
  return {};
}

map::Region RegionOption::region(const std::string& map_bytes, const std::string& name) const {
  if (!within_.empty()) return around_line(map_bytes, name);
  if (!box_.empty()) return box();
  return from_polygons([&](std::span<Eigen::Vector2d> points) {
    map::lon_lat_to_source(map::parse_map(map_bytes, name), points);
  });
}

map::Region RegionOption::region_in(const std::string& crs, const std::string& name) const {
  if (!box_.empty()) return box();
  return from_polygons([&](std::span<Eigen::Vector2d> points) {
    if (!crs.empty()) return map::from_lon_lat(crs, points);
    throw map::InputError({.file = name,
                           .found = "names no coordinate system",
                           .needed = "one, for longitude and latitude to have a place in it",
                           .remedy = "give the polygons in its coordinates, with \"crs\": null"});
  });
}

map::Region RegionOption::box() const {
  return map::Region({geometry::box_ring({box_[0], box_[1]}, {box_[2], box_[3]})});
}

map::Region RegionOption::from_polygons(const FromLonLat& from_lon_lat) const {
  const std::string file = map::input_name(polygon_file_);
  const auto document = map::geojson::parse(map::read_file(polygon_file_), file);
  std::vector<geometry::Ring> rings = rings_of(document, file);
  if (document.in_degrees) {
    std::vector<Eigen::Vector2d> points;
    for (const geometry::Ring& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
    from_lon_lat(points);
    auto point = points.begin();
    for (geometry::Ring& ring : rings) {
      for (Eigen::Vector2d& corner : ring) corner = *point++;
    }
  }
  return map::Region(std::move(rings));
}

map::Region RegionOption::around_line(const std::string& map_bytes, const std::string& name) const {
  const Surroundings asked = surroundings_of(within_).value();
  const map::RoadMap road_map = map::parse_map(map_bytes, name);
  std::vector<Eigen::Vector2d> line = asked.lane.empty() ? line_of_route(asked.route_file, road_map)
                                                         : line_of_lane(asked.lane, road_map, name);
  for (Eigen::Vector2d& point : line) point = road_map.to_source(point);
  return map::region_around(line, asked.distance_m);
}

}  // namespace roadbed::tools::commands::maps
