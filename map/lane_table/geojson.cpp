#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/parse_json.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/lane_table/table.h"

namespace roadbed::map::lane_table {
namespace {

using Json = nlohmann::json;

class GeojsonReader {
 public:
  explicit GeojsonReader(const std::string& name) : name_(name) {}

  Table read(const std::string& bytes) {
    const Json root = parse(bytes);
    if (!root.is_object() || root.value("type", Json()) != "FeatureCollection" ||
        !root.contains("features") || !root["features"].is_array()) {
      refuse("no collection of features", "a FeatureCollection");
    }
    read_system(root);
    for (const Json& feature : root["features"]) add(feature);
    return std::move(table_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& needed) const {
    throw InputError({.file = name_,
                      .element = element_,
                      .found = found,
                      .needed = needed,
                      .remedy = "check whether it is GeoJSON of lines or polygons"});
  }

  Json parse(const std::string& bytes) const {
    try {
      return parse_json(bytes, name_, {.keys_stand_once = false, .most_levels = 32});
    } catch (const Json::exception& error) {
      refuse_json(error, name_);
    }
  }

  // The member crs is of GeoJSON 2008; without it, longitude and latitude (RFC 7946).
  void read_system(const Json& root) {
    table_.in_degrees = !root.contains("crs");
    if (table_.in_degrees || !root["crs"].is_object()) return;
    const Json properties = root["crs"].value("properties", Json());
    const Json name = properties.is_object() ? properties.value("name", Json()) : Json();
    if (name.is_string()) table_.crs = one_line(name.get<std::string>());
    constexpr std::array<std::string_view, 3> geographic = {"CRS84", "4326", "4258"};
    table_.in_degrees = std::ranges::any_of(
        geographic, [&](std::string_view code) { return table_.crs.ends_with(code); });
    if (table_.in_degrees) table_.crs.clear();
  }

  static std::string text_of(const Json& value) {
    return one_line(value.is_string() ? value.get<std::string>() : json_text(value));
  }

  void add(const Json& feature) {
    element_ = fmt::format("feature {}", ++features_);
    if (!feature.is_object()) refuse("no object", "a feature");
    Row row;
    row.id = feature.contains("id") ? text_of(feature["id"]) : std::to_string(features_);
    const Json properties = feature.value("properties", Json());
    if (properties.is_object()) {
      for (const auto& [key, value] : properties.items()) {
        if (!value.is_null()) row.values.emplace_back(one_line(key), text_of(value));
      }
    }
    const Json* list = shape_of(feature.value("geometry", Json()), row);
    if (list == nullptr) {
      ++table_.unused;
      return;
    }
    for (const Json& position : *list) row.points.push_back(point(position));
    if (row.is_ring && row.points.size() > 1 && row.points.front() == row.points.back()) {
      row.points.pop_back();
    }
    table_.rows.push_back(std::move(row));
  }

  /// The positions of a line, or of the outer ring; those of several parts only if there is one.
  const Json* shape_of(const Json& geometry, Row& row) {
    if (!geometry.is_object()) return nullptr;
    shape_ = geometry.value("coordinates", Json());
    const Json type = geometry.value("type", Json());
    row.is_ring = type == "Polygon" || type == "MultiPolygon";
    int levels = type == "LineString" ? 0 : type == "MultiLineString" || type == "Polygon" ? 1 : 2;
    if (levels == 2 && type != "MultiPolygon") return nullptr;
    const Json* list = &shape_;
    for (; levels > 0; --levels) {
      const bool is_ring = row.is_ring && levels == 1;
      if (!list->is_array() || list->empty() || (!is_ring && list->size() > 1)) return nullptr;
      list = &list->front();
    }
    return list->is_array() ? list : nullptr;
  }

  Eigen::Vector3d point(const Json& position) const {
    const bool fits = position.is_array() && position.size() >= 2 && position.size() <= 4 &&
                      std::ranges::all_of(position, [](const Json& n) { return n.is_number(); });
    if (!fits) refuse("a position that is not two or three numbers", "[x, y] or [x, y, z]");
    return {position[0].get<double>(), position[1].get<double>(),
            position.size() > 2 ? position[2].get<double>() : 0.0};
  }

  const std::string& name_;
  std::string element_;
  std::size_t features_ = 0;
  Json shape_;
  Table table_;
};

}  // namespace

std::string_view Row::value(std::string_view column) const {
  const auto found = std::ranges::find(values, column, &std::pair<std::string, std::string>::first);
  return found == values.end() ? std::string_view() : std::string_view(found->second);
}

Table read_geojson(const std::string& bytes, const std::string& name) {
  return GeojsonReader(name).read(bytes);
}

}  // namespace roadbed::map::lane_table
