#include "roadbed/map/gis/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "roadbed/map/derived/lane_relations.h"
#include "roadbed/map/derived/surface.h"
#include "roadbed/map/validation/validate.h"

namespace roadbed::map::inline gis {
namespace {

using Eigen::Vector2d;

Points flat(const geometry::Ring& ring) {
  Points points;
  points.reserve(ring.size());
  for (const Vector2d& point : ring) points.emplace_back(point.x(), point.y(), 0.0);
  return points;
}

Shape ring_shape(const geometry::Ring& ring) {
  if (ring.size() < 3) return {};
  return {{flat(ring)}};
}

template <typename Polygons>
Shape polygons_shape(const Polygons& polygons) {
  Shape shape;
  for (const geometry::Polygon& polygon : polygons) {
    shape.push_back({flat(polygon.outer)});
    for (const geometry::Ring& hole : polygon.holes) shape.back().push_back(flat(hole));
  }
  return shape;
}

Shape line_shape(const LaneLine& line) {
  Points points;
  const auto& in_map = line.in_map.points();
  for (std::size_t i = 0; i < in_map.size(); ++i) {
    points.emplace_back(in_map[i].x(), in_map[i].y(), line.z_m[i]);
  }
  return {{std::move(points)}};
}

Shape point_shape(const Vector2d& at, double z_m) {
  return {{{Eigen::Vector3d(at.x(), at.y(), z_m)}}};
}

Value value_of(const std::optional<double>& number) { return number ? Value(*number) : Value(); }

Value road_id(const RoadMap& road_map, const std::optional<RoadId>& road) {
  return road ? Value(road_map.road(*road).source_id) : Value();
}

Value junction_id(const RoadMap& road_map, const std::optional<JunctionId>& junction) {
  return junction ? Value(road_map.junction(*junction).source_id) : Value();
}

Value neighbour_name(const RoadMap& road_map, const std::optional<Neighbour>& neighbour) {
  return neighbour ? Value(road_map.lane(neighbour->lane).name) : Value();
}

Value lane_name(const RoadMap& road_map, const std::optional<LaneId>& lane) {
  return lane ? Value(road_map.lane(*lane).name) : Value();
}

Value names_of(const RoadMap& road_map, const std::vector<LaneId>& lanes) {
  std::vector<std::string> names;
  names.reserve(lanes.size());
  for (const LaneId id : lanes) names.push_back(road_map.lane(id).name);
  return names;
}

Value text_of(const Attributes& attributes) {
  std::vector<std::string> texts;
  texts.reserve(attributes.size());
  for (const auto& [key, value] : attributes) texts.push_back(fmt::format("{}={}", key, value));
  return texts;
}

double area_of(const std::vector<geometry::Polygon>& polygons) {
  double sum_m2 = 0.0;
  for (const geometry::Polygon& polygon : polygons) sum_m2 += geometry::area_m2(polygon);
  return sum_m2;
}

const std::vector<Column> kLaneColumns = {{"lane", ColumnKind::text},
                                          {"road", ColumnKind::text},
                                          {"section", ColumnKind::whole},
                                          {"junction", ColumnKind::text},
                                          {"type", ColumnKind::text},
                                          {"length_m", ColumnKind::number},
                                          {"speed_limit_mps", ColumnKind::number}};

std::vector<Value> lane_values(const RoadMap& road_map, const Lane& lane) {
  return {lane.name,
          road_id(road_map, lane.road),
          std::int64_t{lane.origin.section},
          junction_id(road_map, lane.junction),
          std::string(to_string(lane.type)),
          lane.length_m(),
          value_of(lane.least_speed_limit_mps())};
}

template <typename T>
std::vector<T> joined(std::vector<T> first, std::vector<T> second) {
  std::move(second.begin(), second.end(), std::back_inserter(first));
  return first;
}

Layer lanes_layer(const RoadMap& road_map) {
  Layer layer{"lanes", "lane", ShapeKind::polygon, false, {}, {}};
  layer.columns = joined(kLaneColumns, {{"area_m2", ColumnKind::number},
                                        {"one_way", ColumnKind::truth},
                                        {"successors", ColumnKind::list},
                                        {"predecessors", ColumnKind::list},
                                        {"left", ColumnKind::text},
                                        {"right", ColumnKind::text},
                                        {"opposite", ColumnKind::text},
                                        {"attributes", ColumnKind::list}});
  const std::vector<std::optional<LaneId>> opposite = opposite_lanes(road_map.graph());
  for (const Lane& lane : road_map.lanes()) {
    const LaneLinks& links = road_map.graph().of(lane.id);
    std::vector<Value> more = {
        geometry::signed_area_m2(lane.polygon),       lane.one_way,
        names_of(road_map, links.successors),         names_of(road_map, links.predecessors),
        neighbour_name(road_map, links.left),         neighbour_name(road_map, links.right),
        lane_name(road_map, opposite[lane.id.index]), text_of(lane.attributes)};
    layer.features.push_back(
        {ring_shape(lane.polygon), joined(lane_values(road_map, lane), std::move(more))});
  }
  return layer;
}

Layer centrelines_layer(const RoadMap& road_map) {
  Layer layer{"centrelines", "centreline", ShapeKind::line, true, kLaneColumns, {}};
  for (const Lane& lane : road_map.lanes()) {
    layer.features.push_back({line_shape(lane.centre), lane_values(road_map, lane)});
  }
  return layer;
}

std::string_view to_string(MarkType type) {
  static constexpr std::array<std::string_view, 12> names = {
      "none",          "solid",      "broken", "solid_solid", "solid_broken", "broken_solid",
      "broken_broken", "botts_dots", "curb",   "grass",       "edge",         "other"};
  return names.at(static_cast<std::size_t>(type));
}

Value first_mark(const std::vector<BorderMark>& marks) {
  return marks.empty() ? Value() : Value(std::string(to_string(marks.front().type)));
}

Layer borders_layer(const RoadMap& road_map) {
  Layer layer{"borders", "border", ShapeKind::line, true, {}, {}};
  layer.columns = joined(kLaneColumns, {{"side", ColumnKind::text}, {"mark", ColumnKind::text}});
  for (const Lane& lane : road_map.lanes()) {
    for (const bool is_left : {true, false}) {
      std::vector<Value> more = {std::string(is_left ? "left" : "right"),
                                 first_mark(is_left ? lane.left_marks : lane.right_marks)};
      layer.features.push_back({line_shape(is_left ? lane.left : lane.right),
                                joined(lane_values(road_map, lane), std::move(more))});
    }
  }
  return layer;
}

Layer roads_layer(const RoadMap& road_map) {
  Layer layer{"roads", "road", ShapeKind::multi_polygon, false, {}, {}};
  layer.columns = {{"road", ColumnKind::text},          {"name", ColumnKind::text},
                   {"junction", ColumnKind::text},      {"length_m", ColumnKind::number},
                   {"lanes", ColumnKind::whole},        {"area_m2", ColumnKind::number},
                   {"weld_moved_m", ColumnKind::number}};
  for (const Road& road : road_map.roads()) {
    const Surface surface = lanes_surface(road_map, road.lanes);
    layer.features.push_back({polygons_shape(surface.polygons),
                              {road.source_id, road.name, junction_id(road_map, road.junction),
                               road.length_m, static_cast<std::int64_t>(road.lanes.size()),
                               area_of(surface.polygons), surface.most_moved_m}});
  }
  return layer;
}

Layer junctions_layer(const RoadMap& road_map) {
  Layer layer{"junctions", "junction", ShapeKind::multi_polygon, false, {}, {}};
  layer.columns = {{"junction", ColumnKind::text},
                   {"name", ColumnKind::text},
                   {"roads", ColumnKind::whole},
                   {"area_m2", ColumnKind::number},
                   {"weld_moved_m", ColumnKind::number}};
  for (const Junction& junction : road_map.junctions()) {
    const Surface surface = lanes_surface(road_map, drivable_lanes(road_map, junction.id));
    layer.features.push_back({polygons_shape(surface.polygons),
                              {junction.source_id, junction.name,
                               static_cast<std::int64_t>(junction.connecting_roads.size()),
                               area_of(surface.polygons), surface.most_moved_m}});
  }
  return layer;
}

Layer drivable_layer(const RoadMap& road_map) {
  Layer layer{"drivable_surface", "drivable_surface", ShapeKind::polygon, false, {}, {}};
  layer.columns = {{"area_m2", ColumnKind::number}, {"weld_moved_m", ColumnKind::number}};
  const Surface surface = lanes_surface(road_map, drivable_lanes(road_map));
  for (const geometry::Polygon& polygon : surface.polygons) {
    layer.features.push_back(
        {polygons_shape(std::array{polygon}), {geometry::area_m2(polygon), surface.most_moved_m}});
  }
  return layer;
}

Layer signals_layer(const RoadMap& road_map) {
  Layer layer{"signals", "signal", ShapeKind::point, true, {}, {}};
  layer.columns = {{"signal", ColumnKind::text},        {"name", ColumnKind::text},
                   {"road", ColumnKind::text},          {"dynamic", ColumnKind::truth},
                   {"country", ColumnKind::text},       {"type", ColumnKind::text},
                   {"subtype", ColumnKind::text},       {"value", ColumnKind::number},
                   {"unit", ColumnKind::text},          {"text", ColumnKind::text},
                   {"heading_rad", ColumnKind::number}, {"lanes", ColumnKind::list},
                   {"attributes", ColumnKind::list}};
  for (const Signal& signal : road_map.signals()) {
    layer.features.push_back(
        {point_shape(signal.in_map, signal.z_m),
         {signal.source_id, signal.name, road_id(road_map, signal.road), signal.dynamic,
          signal.country, signal.type, signal.subtype, value_of(signal.value), signal.unit,
          signal.text, value_of(signal.heading_rad), names_of(road_map, signal.lanes),
          text_of(signal.attributes)}});
  }
  return layer;
}

Layer stop_lines_layer(const RoadMap& road_map) {
  Layer layer{"stop_lines", "stop_line", ShapeKind::line, true, {}, {}};
  layer.columns = {
      {"stop_line", ColumnKind::text}, {"lanes", ColumnKind::list}, {"signals", ColumnKind::list}};
  for (const StopLine& stop_line : road_map.stop_lines()) {
    Shape shape;
    if (stop_line.in_map.size() > 1) shape = {{stop_line.in_map}};
    layer.features.push_back(
        {std::move(shape),
         {stop_line.source_id, names_of(road_map, stop_line.lanes), stop_line.signals}});
  }
  return layer;
}

/// Objects with an outline, or those without.
Layer objects_layer(const RoadMap& road_map, bool outlined) {
  Layer layer{outlined ? "objects" : "object_points",
              "object",
              outlined ? ShapeKind::polygon : ShapeKind::point,
              !outlined,
              {},
              {}};
  layer.columns = {{"object", ColumnKind::text},     {"name", ColumnKind::text},
                   {"type", ColumnKind::text},       {"road", ColumnKind::text},
                   {"height_m", ColumnKind::number}, {"attributes", ColumnKind::list}};
  for (const MapObject& object : road_map.objects()) {
    if ((object.outline_in_map.size() > 2) != outlined) continue;
    layer.features.push_back(
        {outlined ? ring_shape(object.outline_in_map) : point_shape(object.in_map, object.z_m),
         {object.source_id, object.name, object.type, road_id(road_map, object.road),
          object.height_m, text_of(object.attributes)}});
  }
  return layer;
}

Layer areas_layer(const RoadMap& road_map) {
  Layer layer{"areas", "area", ShapeKind::multi_polygon, false, {}, {}};
  layer.columns = {{"area", ColumnKind::text},
                   {"type", ColumnKind::text},
                   {"is_road", ColumnKind::truth},
                   {"area_m2", ColumnKind::number},
                   {"attributes", ColumnKind::list}};
  for (const Area& area : road_map.areas()) {
    layer.features.push_back({polygons_shape(area.in_map),
                              {area.source_id, area.type, area.is_road, area_of(area.in_map),
                               text_of(area.attributes)}});
  }
  return layer;
}

Layer area_centrelines_layer(const RoadMap& road_map) {
  Layer layer{"area_centrelines", "area_centreline", ShapeKind::line, false, {}, {}};
  layer.columns = {{"length_m", ColumnKind::number},
                   {"least_width_m", ColumnKind::number},
                   {"most_width_m", ColumnKind::number}};
  for (const geometry::MedialBranch& branch : road_centrelines(road_map)) {
    const auto [least, most] = std::minmax_element(branch.width_m.begin(), branch.width_m.end());
    layer.features.push_back(
        {{{flat(branch.line.points())}}, {branch.line.length_m(), *least, *most}});
  }
  return layer;
}

Layer findings_layer(const RoadMap& road_map) {
  Layer layer{"findings", "finding", ShapeKind::point, false, {}, {}};
  layer.columns = {{"rule", ColumnKind::text},     {"asam_rule", ColumnKind::text},
                   {"severity", ColumnKind::text}, {"element", ColumnKind::text},
                   {"line", ColumnKind::whole},    {"message", ColumnKind::text}};
  for (const validation::Finding& finding : validation::validate(road_map)) {
    layer.features.push_back(
        {finding.in_map ? point_shape(*finding.in_map, 0.0) : Shape{},
         {finding.rule, finding.asam_rule.empty() ? Value() : Value(finding.asam_rule),
          std::string(to_string(finding.severity)), finding.element,
          finding.line > 0 ? Value(std::int64_t{finding.line}) : Value(), finding.message}});
  }
  return layer;
}

struct Maker {
  std::string_view name;
  Layer (*make)(const RoadMap&);
};

constexpr std::array<Maker, 13> kMakers = {{
    {"areas", areas_layer},
    {"area_centrelines", area_centrelines_layer},
    {"roads", roads_layer},
    {"junctions", junctions_layer},
    {"drivable_surface", drivable_layer},
    {"lanes", lanes_layer},
    {"borders", borders_layer},
    {"centrelines", centrelines_layer},
    {"objects", [](const RoadMap& road_map) { return objects_layer(road_map, true); }},
    {"object_points", [](const RoadMap& road_map) { return objects_layer(road_map, false); }},
    {"stop_lines", stop_lines_layer},
    {"signals", signals_layer},
    {"findings", findings_layer},
}};

}  // namespace

std::vector<std::string> layer_names() {
  std::vector<std::string> names;
  names.reserve(kMakers.size());
  for (const Maker& maker : kMakers) names.emplace_back(maker.name);
  return names;
}

Layer make_layer(const RoadMap& road_map, std::string_view name) {
  for (const Maker& maker : kMakers) {
    if (maker.name == name) return maker.make(road_map);
  }
  throw std::invalid_argument(fmt::format("make_layer: there is no layer \"{}\"", name));
}

std::vector<Layer> make_layers(const RoadMap& road_map, std::span<const std::string> names) {
  std::vector<Layer> layers;
  for (const std::string& name : names) layers.push_back(make_layer(road_map, name));
  if (!names.empty()) return layers;
  for (const std::string& name : layer_names()) {
    Layer layer = make_layer(road_map, name);
    if (!layer.features.empty()) layers.push_back(std::move(layer));
  }
  return layers;
}

}  // namespace roadbed::map::gis
