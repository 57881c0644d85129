#include "roadbed/map/files/projection.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/open_module.h"
#include "roadbed/map/files/proj_module.h"

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

}  // namespace

void to_lon_lat(const std::string& crs, std::span<Eigen::Vector2d> points) {
  transform(crs, true, points);
}

void from_lon_lat(const std::string& crs, std::span<Eigen::Vector2d> points) {
  transform(crs, false, points);
}

std::string well_known_text(const std::string& crs) {
  static auto& describe = proj_function<RoadbedProjWkt>("roadbed_proj_wkt", crs);
  Message message{};
  std::vector<char> wkt(1U << 16U);
  if (describe(crs.c_str(), wkt.data(), wkt.size(), message.data(), message.size()) != 0) {
    refuse_unknown(crs, message);
  }
  return wkt.data();
}

void open_projection_module() { function_of_module("libroadbed_proj", "roadbed_proj_wkt"); }

std::optional<int> epsg_code(const std::string& crs) {
  constexpr std::string_view kPrefix = "EPSG:";
  if (!crs.starts_with(kPrefix)) return std::nullopt;
  int code = 0;
  const char* end = crs.data() + crs.size();
  const auto [rest, fault] = std::from_chars(crs.data() + kPrefix.size(), end, code);
  if (fault != std::errc() || rest != end || code <= 0) return std::nullopt;
  return code;
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
