#include "roadbed/map/lanelet2/crs_text.h"

#include <charconv>
#include <cmath>
#include <map>
#include <string>

namespace roadbed::map::lanelet2 {
namespace {

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
  if ((code / 100 != 326 && code / 100 != 327) || zone < 1 || zone > 60) return {};
  return utm_grid(zone, code / 100 == 327);
}

}  // namespace

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
