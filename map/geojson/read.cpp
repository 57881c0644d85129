#include "roadbed/map/geojson/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/elements/lane_lines.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/utm_region.h"
#include "roadbed/map/geojson/document.h"

namespace roadbed::map::geojson {
namespace {

const Eigen::Vector2d* first_position(const Document& document) {
  for (const FeatureRecord& feature : document.features) {
    for (const PolygonRecord& polygon : feature.polygons) {
      for (const Positions& ring : polygon.rings) {
        if (!ring.empty()) return &ring.front();
      }
    }
  }
  return nullptr;
}

std::string ring_name(std::size_t ring) {
  return ring == 0 ? std::string("its outer ring") : fmt::format("its hole {}", ring);
}

void turn(geometry::Ring& ring, bool counter_clockwise) {
  if ((geometry::signed_area_m2(ring) > 0.0) != counter_clockwise) {
    std::reverse(ring.begin(), ring.end());
  }
}

class AreaBuilder {
 public:
  /// @param region  of a file in degrees; none if its positions are metres.
  AreaBuilder(const std::string& name, const std::optional<UtmRegion>& region, RoadMapParts& parts)
      : name_(name), region_(region), parts_(parts) {}

  Eigen::Vector2d to_source(const Eigen::Vector2d& position, const std::string& element) const {
    return region_ ? region_->metres_of(position, name_, element) : position;
  }

  void add(const FeatureRecord& feature) {
    Area area;
    area.source_id = feature.id;
    area.is_road = true;
    area.participants = Participants::vehicles();
    area.attributes = feature.properties;
    for (const auto& [key, value] : feature.properties) {
      if (key == "type" || (key == "highway" && area.type.empty())) area.type = value;
    }
    for (std::size_t i = 0; i < feature.polygons.size(); ++i) {
      const std::string element = fmt::format("feature {}, polygon {}", feature.number, i + 1);
      if (auto polygon = polygon_of(feature.polygons[i], element)) {
        area.in_map.push_back(std::move(*polygon));
      }
    }
    if (!area.in_map.empty()) parts_.areas.push_back(std::move(area));
  }

 private:
  std::optional<geometry::Polygon> polygon_of(const PolygonRecord& record,
                                              const std::string& element) {
    if (record.was_open) {
      parts_.remarks.push_back({"import.open-ring", true, element, 0,
                                "a ring does not end where it begins; it is closed"});
    }
    geometry::Polygon polygon;
    for (std::size_t i = 0; i < record.rings.size(); ++i) {
      geometry::Ring ring;
      for (const Eigen::Vector2d& position : record.rings[i]) {
        ring.emplace_back(to_source(position, element) - parts_.origin_in_source);
      }
      if (i == 0)
        polygon.outer = std::move(ring);
      else
        polygon.holes.push_back(std::move(ring));
    }
    if (const auto fault = geometry::find_fault(polygon)) {
      parts_.remarks.push_back(
          {"import.polygon", true, element, 0,
           fmt::format("{}: {}; the polygon is left out", ring_name(fault->ring), fault->what)});
      return {};
    }
    turn(polygon.outer, true);
    for (geometry::Ring& hole : polygon.holes) turn(hole, false);
    return polygon;
  }

  const std::string& name_;
  const std::optional<UtmRegion>& region_;
  RoadMapParts& parts_;
};

[[noreturn]] void refuse_empty(const std::string& name, const RoadMapParts& parts) {
  const bool has_fault = !parts.remarks.empty();
  throw InputError({.file = name,
                    .element = has_fault ? parts.remarks.back().element : std::string(),
                    .found = has_fault ? parts.remarks.back().message : "no polygon",
                    .needed = "at least one usable Polygon or MultiPolygon",
                    .remedy = "give a file of road-surface polygons"});
}

}  // namespace

bool is_geojson(std::string_view bytes) {
  const auto first = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return first != std::string::npos && bytes[first] == '{';
}

RoadMapParts read(const std::string& bytes, const std::string& name) {
  const Document document = parse(bytes, name);
  RoadMapParts parts;
  parts.format = "GeoJSON";
  for (const auto& [kind, count] : document.unused) parts.unused.push_back({kind, count});
  const Eigen::Vector2d* first = first_position(document);
  if (!first) refuse_empty(name, parts);
  const std::optional<UtmRegion> region =
      document.in_degrees ? std::optional<UtmRegion>(*first) : std::nullopt;
  parts.crs = region ? region->crs() : document.crs;
  AreaBuilder builder(name, region, parts);
  parts.origin_in_source = origin_near(builder.to_source(*first, ""));
  for (const FeatureRecord& feature : document.features) builder.add(feature);
  if (parts.areas.empty()) refuse_empty(name, parts);
  return parts;
}

}  // namespace roadbed::map::geojson
