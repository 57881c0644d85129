#include "roadbed/map/files/projection.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/open_module.h"
#include "roadbed/map/files/proj_module.h"
#include "roadbed/map/files/transverse_mercator.h"

namespace roadbed::map::inline files {
namespace {

using Message = std::array<char, 256>;

[[noreturn]] void refuse(const std::string& crs, const std::string& found,
                         const std::string& remedy) {
  throw InputError({.file = "coordinate reference system",
                    .element = fmt::format("\"{}\"", crs),
                    .found = found,
                    .remedy = remedy});
}

template <typename Function>
Function& proj_function(const char* name, const std::string& crs) {
  const ModuleFunction found = function_of_module("libroadbed_proj", name);
  if (found.address != nullptr) return *reinterpret_cast<Function*>(found.address);
  refuse(crs, found.fault,
         "install PROJ (Debian: libproj25; libproj-dev before roadbed is built), or write another "
         "format");
}

[[noreturn]] void refuse_unknown(const std::string& crs, const Message& message) {
  refuse(crs, fmt::format("PROJ cannot use it: {}", message.data()),
         "correct it in the map, or name it with import --crs");
}

void transform(const std::string& crs, bool to_lon_lat, std::span<Eigen::Vector2d> points) {
  static auto& function = proj_function<RoadbedProjLonLat>("roadbed_proj_lon_lat", crs);
  if (points.empty()) return;
  static_assert(sizeof(Eigen::Vector2d) == 2 * sizeof(double));
  Message message{};
  const int fault = function(crs.c_str(), to_lon_lat ? 1 : 0, points.front().data(), points.size(),
                             message.data(), message.size());
  if (fault != 0) refuse_unknown(crs, message);
}

bool describe(const std::string& crs, std::vector<char>& wkt, Message& message) {
  static auto& function = proj_function<RoadbedProjWkt>("roadbed_proj_wkt", crs);
  return function(crs.c_str(), wkt.data(), wkt.size(), message.data(), message.size()) == 0;
}

/// What a word of a PROJ string says, as "32" of "+zone=32" or "zone=32"; a word without a value
/// says "".
std::map<std::string, std::string, std::less<>> words_of_proj(const std::string& crs) {
  std::map<std::string, std::string, std::less<>> words;
  std::istringstream text(crs);
  for (std::string word; text >> word;) {
    word.erase(0, word.find_first_not_of('+'));
    const std::size_t sign = word.find('=');
    words.emplace(word.substr(0, sign), sign == word.npos ? "" : word.substr(sign + 1));
  }
  return words;
}

std::optional<int> epsg_of_proj(const std::string& crs) {
  const auto words = words_of_proj(crs);
  const auto says = [&](std::string_view word, std::string_view value) {
    const auto found = words.find(word);
    return found != words.end() && found->second == value;
  };
  const auto is_zero = [](char c) { return c == '0' || c == ',' || c == '.'; };
  const auto shift = words.find("towgs84");
  const bool is_shifted =
      shift != words.end() && !std::all_of(shift->second.begin(), shift->second.end(), is_zero);
  const bool is_wgs84 =
      says("datum", "WGS84") || (says("ellps", "WGS84") && !words.contains("datum") && !is_shifted);
  const bool in_metres = !words.contains("units") || says("units", "m");
  if (!is_wgs84 || words.contains("nadgrids") || words.contains("pm")) return {};
  if (says("proj", "longlat")) return 4326;
  const auto zone = words.find("zone");
  if (!says("proj", "utm") || !in_metres || zone == words.end()) return {};
  int number = 0;
  const char* end = zone->second.data() + zone->second.size();
  const auto [rest, fault] = std::from_chars(zone->second.data(), end, number);
  if (fault != std::errc() || rest != end || number < 1 || number > 60) return {};
  return epsg_of_utm(number, words.contains("south"));
}

}  // namespace

void to_lon_lat(const std::string& crs, std::span<Eigen::Vector2d> points) {
  transform(crs, true, points);
}

void from_lon_lat(const std::string& crs, std::span<Eigen::Vector2d> points) {
  transform(crs, false, points);
}

std::string well_known_text(const std::string& crs) {
  std::vector<char> wkt(1U << 16U);
  Message message{};
  if (!describe(crs, wkt, message)) refuse_unknown(crs, message);
  return wkt.data();
}

void require_metres(const std::string& crs) {
  const std::string text = well_known_text(crs);
  const std::size_t unit = text.rfind("UNIT["), factor = text.find(',', unit);
  if (text.starts_with("PROJCS[") && factor != std::string::npos &&
      std::strtod(&text[factor + 1], nullptr) == 1.0) {
    return;
  }
  refuse(crs, "not a projected system in metres", "name one, as EPSG:32632");
}

std::string projection_fault(const std::string& crs) {
  std::vector<char> wkt(1U << 16U);
  Message message{};
  return describe(crs, wkt, message) ? std::string() : message.data();
}

void open_projection_module() { function_of_module("libroadbed_proj", "roadbed_proj_wkt"); }

std::optional<int> epsg_code(const std::string& crs) {
  constexpr std::string_view kPrefix = "EPSG:";
  if (!crs.starts_with(kPrefix)) return epsg_of_proj(crs);
  int code = 0;
  const char* end = crs.data() + crs.size();
  const auto [rest, fault] = std::from_chars(crs.data() + kPrefix.size(), end, code);
  if (fault != std::errc() || rest != end || code <= 0) return std::nullopt;
  return code;
}

std::string proj_string(const std::string& crs) {
  const int code = epsg_code(crs).value_or(0);
  const int zone = code % 100;
  const bool north = code / 100 == 326, south = code / 100 == 327;
  if (!crs.starts_with("EPSG:") || zone < 1 || zone > 60 || !(north || south)) return crs;
  return fmt::format("+proj=utm +zone={}{} +datum=WGS84 +units=m +no_defs", zone,
                     south ? " +south" : "");
}

std::string system_anchored_at(double latitude_deg, double longitude_deg) {
  if (!(std::abs(latitude_deg) <= 90.0) || !(std::abs(longitude_deg) <= 180.0)) {
    throw std::invalid_argument(
        fmt::format("system_anchored_at: latitude {} or longitude {} is not on the globe",
                    latitude_deg, longitude_deg));
  }
  return fmt::format(
      "+proj=tmerc +lat_0={} +lon_0={} +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs",
      latitude_deg, longitude_deg);
}

}  // namespace roadbed::map::files
