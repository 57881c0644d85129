#include "roadbed/tools/commands/region_option.h"

#include <fmt/format.h>

#include <charconv>
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

namespace roadbed::tools::inline commands {
namespace {

/// "lane:12/0/-1,500m": the lane's name and the distance.
struct Surroundings {
  std::string lane;
  double distance_m = 0.0;
};

std::optional<Surroundings> surroundings_of(std::string_view text) {
  constexpr double kMost_m = 1e6;
  constexpr std::string_view prefix = "lane:";
  const std::size_t comma = text.rfind(',');
  if (!text.starts_with(prefix) || comma == text.npos) return {};
  const std::string_view number = text.substr(comma + 1);
  Surroundings found{std::string(text.substr(prefix.size(), comma - prefix.size())), 0.0};
  const char* end = number.data() + number.size();
  const auto [rest, error] = std::from_chars(number.data(), end, found.distance_m);
  const bool fits = error == std::errc() && std::string_view(rest, end) == "m" &&
                    found.distance_m > 0.0 && found.distance_m <= kMost_m;
  return fits && !found.lane.empty() ? std::optional(found) : std::nullopt;
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
  arguments.add("--within", within_, "The part within a distance of a lane: lane:NAME,500m")
      .checked([](const std::string& text) {
        return surroundings_of(text) ? "" : "is not lane:NAME,500m, of at most 1000000 m";
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
  if (!within_.empty()) return around_lane(map_bytes, name);
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

map::Region RegionOption::around_lane(const std::string& map_bytes, const std::string& name) const {
  const Surroundings asked = surroundings_of(within_).value();
  const map::RoadMap road_map = map::parse_map(map_bytes, name);
  const auto lane = road_map.find_lane(asked.lane);
  if (!lane) {
    throw map::InputError({.file = name,
                           .found = fmt::format("no lane {}", asked.lane),
                           .needed = "a lane of the map for --within",
                           .remedy = "see the names with: roadbed locate MAP --at X,Y"});
  }
  std::vector<Eigen::Vector2d> line;
  for (const Eigen::Vector2d& point : road_map.lane(*lane).centre.in_map.points()) {
    line.push_back(road_map.to_source(point));
  }
  return map::region_around(line, asked.distance_m);
}

}  // namespace roadbed::tools::commands
