#include "roadbed/map/gis/write.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "roadbed/map/files/json_text.h"

namespace roadbed::map::inline gis {
namespace {

using Json = nlohmann::ordered_json;

/// Names of sources are not always valid UTF-8; JSON has to be.
std::string text_of(const Json& json) { return json_text(json); }

Json json_of(const Value& value) {
  return std::visit(
      [](const auto& held) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::monostate>) {
          return nullptr;
        } else {
          return held;
        }
      },
      value);
}

class Writer {
 public:
  explicit Writer(bool lon_lat) : lon_lat_(lon_lat) {}

  std::string feature(const Layer& layer, const Feature& feature) const {
    Json properties = {{"kind", layer.kind}};
    for (std::size_t i = 0; i < layer.columns.size(); ++i) {
      properties[layer.columns[i].name] = json_of(feature.values[i]);
    }
    return R"({"type":"Feature","geometry":)" + geometry(layer, feature.shape) +
           R"(,"properties":)" + text_of(properties) + "}";
  }

 private:
  void add_number(double number, std::string& text) const {
    // As a whole number of the unit in the last place, so that the shortest text is short.
    const double shown = lon_lat_ ? std::round(number * 1e9) / 1e9 : number;
    fmt::format_to(std::back_inserter(text), "{}", shown == 0.0 ? 0.0 : shown);  // never "-0"
  }

  std::string position(const Eigen::Vector3d& point, bool has_z) const {
    std::string text = "[";
    add_number(point.x(), text);
    text += ',';
    add_number(point.y(), text);
    if (has_z) fmt::format_to(std::back_inserter(text), ",{}", point.z() == 0.0 ? 0.0 : point.z());
    return text + ']';
  }

  std::string line(const Points& points, bool has_z, bool close) const {
    std::string text = "[";
    for (const Eigen::Vector3d& point : points) {
      if (text.size() > 1) text += ',';
      text += position(point, has_z);
    }
    if (close) text += ',' + position(points.front(), has_z);
    return text + ']';
  }

  std::string polygon(const std::vector<Points>& rings, bool has_z) const {
    std::string text = "[";
    for (const Points& ring : rings) {
      if (text.size() > 1) text += ',';
      text += line(ring, has_z, true);
    }
    return text + ']';
  }

  std::string multi_polygon(const Shape& shape, bool has_z) const {
    std::string text = "[";
    for (const auto& rings : shape) {
      if (text.size() > 1) text += ',';
      text += polygon(rings, has_z);
    }
    return text + ']';
  }

  std::string geometry(const Layer& layer, const Shape& shape) const {
    if (shape.empty()) return "null";
    const auto typed = [](const char* type, const std::string& coordinates) {
      return fmt::format(R"({{"type":"{}","coordinates":{}}})", type, coordinates);
    };
    switch (layer.shape) {
      case ShapeKind::point:
        return typed("Point", position(shape[0][0][0], layer.has_z));
      case ShapeKind::line:
        return typed("LineString", line(shape[0][0], layer.has_z, false));
      case ShapeKind::polygon:
        return typed("Polygon", polygon(shape[0], layer.has_z));
      case ShapeKind::multi_polygon:
        return typed("MultiPolygon", multi_polygon(shape, layer.has_z));
    }
    return "null";
  }

  bool lon_lat_;
};

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

}  // namespace

std::string write_geojson(std::span<const Layer> layers, const GeojsonHead& head) {
  std::string text = R"({"type":"FeatureCollection",)";
  if (!head.lon_lat) text += "\n\"crs\":null,";
  text += "\n\"source_format\":" + text_of(head.source_format) +
          ",\n\"source_crs\":" + text_of(text_or_null(head.source_crs)) + ",\n\"features\":[";
  const Writer writer(head.lon_lat);
  const char* separator = "\n";
  for (const Layer& layer : layers) {
    for (const Feature& feature : layer.features) {
      text += separator + writer.feature(layer, feature);
      separator = ",\n";
    }
  }
  return text + "\n]}\n";
}

}  // namespace roadbed::map::gis
