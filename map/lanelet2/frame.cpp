#include "roadbed/map/lanelet2/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <mutex>
#include <string>

#include "roadbed/map/files/coordinate_limits.h"
#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/files/mgrs.h"
#include "roadbed/map/files/utm_region.h"

namespace roadbed::map::lanelet2 {
namespace {

constexpr double kAgreement_m = 0.01;

// Autoware writes zeros where it knows local coordinates only.
bool is_geographic(const NodePlace& node) {
  return node.is_on_earth() &&
         !(node.is_local() && node.latitude_deg == 0.0 && node.longitude_deg == 0.0);
}

GeographicPoint geographic(const NodePlace& node) {
  return {node.latitude_deg, node.longitude_deg};
}

bool has_both(const NodePlace& node) { return node.is_local() && is_geographic(node); }

double worst_difference_m(const TransverseMercator& grid, std::span<const NodePlace> nodes,
                          int threads) {
  std::mutex mutex;
  double worst_m = 0.0;
  in_threads_by_runs(nodes.size(), threads, [&](std::size_t from, std::size_t to) {
    double worst_here_m = 0.0;
    for (const NodePlace& node : nodes.subspan(from, to - from)) {
      if (!has_both(node)) continue;
      const Eigen::Vector2d local(node.local_x_m, node.local_y_m);
      worst_here_m = std::max(worst_here_m, (grid.forward(geographic(node)) - local).norm());
    }
    const std::scoped_lock lock(mutex);
    worst_m = std::max(worst_m, worst_here_m);
  });
  return worst_m;
}

// "+key=value +flag …" as keys and values; a flag has an empty value.
using Parameters = std::map<std::string, std::string, std::less<>>;

Parameters parameters_of(std::string_view crs) {
  Parameters parameters;
  while (!crs.empty()) {
    const std::size_t space = crs.find_first_of(" \t\r\n");
    std::string_view word = crs.substr(0, space);
    crs = space == crs.npos ? std::string_view() : crs.substr(space + 1);
    if (!word.starts_with('+')) continue;
    word.remove_prefix(1);
    const std::size_t equals = word.find('=');
    parameters.emplace(word.substr(0, equals),
                       equals == word.npos ? std::string_view() : word.substr(equals + 1));
  }
  return parameters;
}

std::optional<double> number(const Parameters& parameters, std::string_view key, double fallback) {
  const auto found = parameters.find(key);
  if (found == parameters.end()) return fallback;
  const std::string& text = found->second;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

bool says(const Parameters& parameters, std::string_view key, std::string_view value) {
  const auto found = parameters.find(key);
  return found != parameters.end() && found->second == value;
}

bool is_on_wgs84(const Parameters& parameters) {
  const bool named = says(parameters, "datum", "WGS84") || says(parameters, "ellps", "WGS84") ||
                     says(parameters, "ellps", "GRS80");
  return named || (!parameters.contains("datum") && !parameters.contains("ellps") &&
                   !parameters.contains("a"));
}

std::optional<TransverseMercator> grid_of_epsg(std::string_view digits) {
  int code = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code);
  if (error != std::errc() || end != digits.data() + digits.size()) return {};
  const int zone = code % 100;
  const bool on_wgs84 = (code / 100 == 326 || code / 100 == 327) && zone >= 1 && zone <= 60;
  const bool on_etrs89 = code / 100 == 258 && zone >= 28 && zone <= 38;
  if (!on_wgs84 && !on_etrs89) return {};
  return utm_grid(zone, code / 100 == 327);
}

}  // namespace

std::string crs_text(const TransverseMercator& grid) {
  const double longitude_deg = grid.central_meridian_deg;
  const int zone = static_cast<int>((longitude_deg + 183.0) / 6.0);
  for (const bool south : {false, true}) {
    const TransverseMercator whole = utm_grid(zone, south);
    if (grid.false_easting_m == whole.false_easting_m &&
        grid.false_northing_m == whole.false_northing_m) {
      return crs_of_utm(zone, south);
    }
  }
  return fmt::format(
      "+proj=tmerc +lat_0=0 +lon_0={} +k=0.9996 +x_0={} +y_0={} +datum=WGS84 +units=m +no_defs",
      longitude_deg, grid.false_easting_m, grid.false_northing_m);
}

bool NodePlace::is_local() const {
  return std::abs(local_x_m) <= kFarthestM && std::abs(local_y_m) <= kFarthestM;
}

bool NodePlace::is_on_earth() const {
  return std::abs(latitude_deg) <= 90.0 && std::abs(longitude_deg) <= 360.0;
}

Frame::Frame(std::span<const NodePlace> nodes, std::string_view mgrs_code, int threads) {
  const auto locals = std::ranges::count_if(nodes, &NodePlace::is_local);
  const auto others = std::count_if(nodes.begin(), nodes.end(), [](const NodePlace& node) {
    return !node.is_local() && is_geographic(node);
  });
  local_ = locals > 0 && locals >= others;
  if (local_) {
    find_local_grid(nodes, mgrs_code, threads);
    return;
  }
  const auto first = std::find_if(nodes.begin(), nodes.end(), is_geographic);
  if (first == nodes.end()) return;
  const UtmRegion region({first->longitude_deg, first->latitude_deg});
  grid_ = region.grid();
  crs_ = region.crs();
}

void Frame::find_local_grid(std::span<const NodePlace> nodes, std::string_view mgrs_code,
                            int threads) {
  const auto first = std::find_if(nodes.begin(), nodes.end(), has_both);
  TransverseMercator grid;
  if (first == nodes.end()) {
    const std::optional<MgrsSquare> square = mgrs_square(mgrs_code);
    if (!square) {
      doubt_ = "its nodes have local_x and local_y only";
      return;
    }
    grid = utm_grid(square->zone, square->south);
    grid.false_easting_m -= square->corner_m.x();
    grid.false_northing_m -= square->corner_m.y();
  } else {
    grid = utm_grid(utm_zone(geographic(*first)), first->latitude_deg < 0.0);
    const Eigen::Vector2d shift_m =
        grid.forward(geographic(*first)) - Eigen::Vector2d(first->local_x_m, first->local_y_m);
    grid.false_easting_m -= std::round(shift_m.x() * 1e3) / 1e3;
    grid.false_northing_m -= std::round(shift_m.y() * 1e3) / 1e3;
    const double worst_m = worst_difference_m(grid, nodes, threads);
    if (!(worst_m <= kAgreement_m)) {
      doubt_ =
          fmt::format("its local coordinates differ from its lat/lon by up to {:.3g} m", worst_m);
      return;
    }
  }
  grid_ = grid;
  crs_ = crs_text(grid);
}

std::optional<Eigen::Vector2d> Frame::place(const NodePlace& node) const {
  if (local_ && node.is_local()) return Eigen::Vector2d(node.local_x_m, node.local_y_m);
  if (!grid_ || !is_geographic(node)) return {};
  if (!grid_->reaches(geographic(node))) return {};
  return grid_->forward(geographic(node));
}

std::optional<TransverseMercator> transverse_mercator_of(std::string_view crs) {
  if (crs.starts_with("EPSG:") || crs.starts_with("epsg:")) return grid_of_epsg(crs.substr(5));
  const Parameters parameters = parameters_of(crs);
  if (!is_on_wgs84(parameters) ||
      (parameters.contains("units") && !says(parameters, "units", "m"))) {
    return {};
  }
  if (says(parameters, "proj", "utm")) {
    const auto zone = number(parameters, "zone", 0.0);
    if (!zone || !(*zone >= 1.0 && *zone <= 60.0)) return {};
    return utm_grid(static_cast<int>(*zone), parameters.contains("south"));
  }
  if (!says(parameters, "proj", "tmerc")) return {};
  const auto meridian = number(parameters, "lon_0", 0.0);
  const auto latitude = number(parameters, "lat_0", 0.0);
  const auto scale = number(parameters, parameters.contains("k_0") ? "k_0" : "k", 1.0);
  const auto east_m = number(parameters, "x_0", 0.0), north_m = number(parameters, "y_0", 0.0);
  if (!meridian || !latitude || !scale || !east_m || !north_m) return {};
  if (!(*scale > 0.0) || !(std::abs(*latitude) <= 90.0)) return {};
  return TransverseMercator{*meridian, *latitude, *scale, *east_m, *north_m};
}

}  // namespace roadbed::map::lanelet2
