#include "roadbed/map/geojson/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "roadbed/map/files/coordinate_limits.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/parse_json.h"
#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::geojson {
namespace {

using Json = nlohmann::json;

class Parser {
 public:
  explicit Parser(const std::string& name) : name_(name) {}

  Document parse(const std::string& bytes) {
    const Json root = parse_json(bytes);
    read_crs(root);
    const std::string type = type_of(root);
    if (type == "FeatureCollection") {
      const auto features = root.find("features");
      if (features == root.end() || !features->is_array()) {
        refuse("no list \"features\"", "a list of features", "check whether it is GeoJSON");
      }
      for (const Json& feature : *features) add_feature(feature);
    } else if (type == "Feature") {
      add_feature(root);
    } else {
      FeatureRecord record;
      record.number = 1;
      record.id = "1";
      add_geometry(root, 0, record);
      document_.features.push_back(std::move(record));
    }
    return std::move(document_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& needed,
                           const std::string& remedy) const {
    throw InputError(
        {.file = name_, .element = element_, .found = found, .needed = needed, .remedy = remedy});
  }

  Json parse_json(const std::string& bytes) {
    // What is nested deeper is no GeoJSON, and could not be written again without a deep stack.
    constexpr std::size_t deepest = 32;
    try {
      return files::parse_json(bytes, name_, {.keys_stand_once = false, .most_levels = deepest});
    } catch (const Json::exception& error) {
      refuse_json(error, name_);
    }
  }

  static std::string type_of(const Json& object) {
    if (!object.is_object()) return {};
    const auto type = object.find("type");
    return type != object.end() && type->is_string() ? type->get<std::string>() : std::string();
  }

  // RFC 7946 knows longitude and latitude only; GeoJSON 2008 has the member crs, null where the
  // system is unknown.
  void read_crs(const Json& root) {
    if (!root.is_object() || !root.contains("crs")) return;
    const Json& crs = root["crs"];
    if (crs.is_object() && crs.contains("properties") && crs["properties"].is_object()) {
      const Json& name = crs["properties"].value("name", Json());
      if (name.is_string()) document_.crs = one_line(name.get<std::string>());
    }
    if (!crs.is_null() && document_.crs.empty()) {
      refuse("the member crs names no system", "null, or properties with a name",
             "name the coordinate system, or remove the member");
    }
    constexpr std::array<std::string_view, 4> geographic = {"CRS84", "4326", "4258", "WGS84"};
    document_.in_degrees =
        std::any_of(geographic.begin(), geographic.end(),
                    [&](std::string_view code) { return document_.crs.ends_with(code); });
    if (document_.in_degrees) document_.crs.clear();
  }

  static std::string text_of(const Json& value) {
    if (value.is_string()) return one_line(value.get<std::string>());
    return json_text(value);
  }

  void add_feature(const Json& feature) {
    FeatureRecord record;
    record.number = ++features_;
    element_ = fmt::format("feature {}", record.number);
    if (type_of(feature) != "Feature") {
      refuse("not a feature", "an object of type Feature", "correct or remove it");
    }
    record.id = feature.contains("id") ? text_of(feature["id"]) : std::to_string(record.number);
    if (feature.contains("properties") && feature["properties"].is_object()) {
      for (const auto& [key, value] : feature["properties"].items()) {
        if (!value.is_null()) record.properties.emplace_back(one_line(key), text_of(value));
      }
    }
    if (feature.contains("geometry")) add_geometry(feature["geometry"], 0, record);
    document_.features.push_back(std::move(record));
  }

  void add_geometry(const Json& geometry, int depth, FeatureRecord& record) {
    constexpr int deepest = 4;
    const std::string type = type_of(geometry);
    if (type == "Polygon") {
      record.polygons.push_back(polygon_of(list_in(geometry, "coordinates")));
    } else if (type == "MultiPolygon") {
      for (const Json& rings : list_in(geometry, "coordinates")) {
        record.polygons.push_back(polygon_of(rings));
      }
    } else if (type == "GeometryCollection" && depth < deepest) {
      for (const Json& part : list_in(geometry, "geometries")) {
        add_geometry(part, depth + 1, record);
      }
    } else {
      ++document_.unused["geometry/" + (type.empty() ? "none" : type)];
    }
  }

  const Json& list_in(const Json& object, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_array()) {
      refuse(fmt::format("no list \"{}\"", key), "a list", "correct or remove the feature");
    }
    return *found;
  }

  PolygonRecord polygon_of(const Json& rings) const {
    if (!rings.is_array() || rings.empty()) {
      refuse("a polygon without rings", "an outer ring", "correct or remove the feature");
    }
    PolygonRecord polygon;
    for (const Json& ring : rings) add_ring(ring, polygon);
    return polygon;
  }

  void add_ring(const Json& ring, PolygonRecord& polygon) const {
    if (!ring.is_array()) refuse("a ring that is no list", "a list of positions", "correct it");
    Positions positions;
    for (const Json& position : ring) positions.push_back(position_of(position));
    if (positions.size() > 1 && positions.front() == positions.back()) {
      positions.pop_back();
    } else {
      polygon.was_open = true;
    }
    positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
    polygon.rings.push_back(std::move(positions));
  }

  Eigen::Vector2d position_of(const Json& position) const {
    if (!position.is_array() || position.size() < 2 || !position[0].is_number() ||
        !position[1].is_number()) {
      refuse("a position that is not two numbers", "[x, y]", "correct it");
    }
    const Eigen::Vector2d at(position[0].get<double>(), position[1].get<double>());
    if (document_.in_degrees && (std::abs(at.x()) > 180.0 || std::abs(at.y()) > 90.0)) {
      refuse(fmt::format("[{}, {}] is no longitude and latitude", at.x(), at.y()),
             "degrees, or another system named by the member crs",
             "name the coordinate system in crs, or set crs to null where it is unknown");
    }
    if (!(at.cwiseAbs().maxCoeff() <= kFarthestM)) {
      refuse(fmt::format("[{}, {}] is beyond any road", at.x(), at.y()), "|x|, |y| ≤ 1e8 m",
             "correct the position");
    }
    return at;
  }

  const std::string& name_;
  std::string element_;
  std::size_t features_ = 0;
  Document document_;
};

}  // namespace

Document parse(const std::string& bytes, const std::string& name) {
  return Parser(name).parse(bytes);
}

}  // namespace roadbed::map::geojson
