#include "roadbed/map/argoverse/city.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "roadbed/map/files/transverse_mercator.h"
#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::argoverse {
namespace {

struct City {
  std::string_view name;
  int utm_zone;  // north
  GeographicPoint origin;
};

constexpr std::array<City, 6> kCities = {{
    {"ATX", 14, {30.27464237939507, -97.7404457407424}},
    {"DTW", 17, {42.29993066912924, -83.17555750783717}},
    {"MIA", 17, {25.77452579915163, -80.19656914449405}},
    {"PAO", 10, {37.416065, -122.13571963362166}},
    {"PIT", 17, {40.44177902989321, -80.01294377242584}},
    {"WDC", 18, {38.889377, -77.0355047439081}},
}};

/// What stands between the end of one text and the next other one, or the end; empty without it.
std::string_view between(std::string_view text, std::string_view before, std::string_view after) {
  const std::size_t at = text.find(before);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = text.substr(at + before.size());
  return rest.substr(0, rest.find(after));
}

}  // namespace

void add_city(std::string_view file_name, MapHead& head) {
  const std::string_view archive = between(file_name, "log_map_archive_", ".json");
  const std::string_view log_id = archive.substr(0, archive.find("____"));
  if (!log_id.empty()) head.attributes.emplace_back("log_id", one_line(std::string(log_id)));
  const std::string_view name = between(archive, "____", "_city");
  if (name.empty()) return;
  head.attributes.emplace_back("city", one_line(std::string(name)));
  const auto* city = std::ranges::find(kCities, name, &City::name);
  if (city == kCities.end()) return;
  const Eigen::Vector2d origin = utm_grid(city->utm_zone, false).forward(city->origin);
  head.crs = fmt::format("EPSG:{}", 32600 + city->utm_zone);
  head.offset_in_crs = {.x_m = origin.x(), .y_m = origin.y()};
}

}  // namespace roadbed::map::argoverse
