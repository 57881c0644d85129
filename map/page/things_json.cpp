#include <fmt/format.h>

#include <array>
#include <cmath>

#include "roadbed/map/page/map_page.h"
#include "roadbed/map/page/page_data.h"

namespace roadbed::map::inline page {
namespace {

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

Json place_json(const Eigen::Vector2d& in_map) {
  return {rounded(in_map.x()), rounded(in_map.y())};
}

Json indices(const std::vector<LaneId>& lanes) {
  Json made = Json::array();
  for (const LaneId id : lanes) made.push_back(id.index);
  return made;
}

template <typename Id>
Json index_of(const std::optional<Id>& id) {
  return id ? Json(id->index) : Json();
}

template <typename Points>
std::vector<Eigen::Vector2d> flat(const Points& points) {
  std::vector<Eigen::Vector2d> made;
  for (const Eigen::Vector3d& point : points) made.push_back(point.head<2>());
  return made;
}

Json roads_json(const RoadMap& road_map) {
  Json ids = Json::array(), names = Json::array();
  Column junctions, lengths, road_s;
  LineColumns references;
  for (const Road& road : road_map.roads()) {
    ids.push_back(road.source_id);
    names.push_back(road.name);
    junctions.add_step(road.junction ? road.junction->index + 1 : 0);
    lengths.add(std::llround(road.length_m * 1e3));
    references.add(road.reference_in_map.points());
    for (const double s_m : road.reference_road_s_m) road_s.add_step(std::llround(s_m * 1e4));
  }
  return {{"ids", std::move(ids)},           {"names", std::move(names)},
          {"junction", junctions.text()},    {"lengths", lengths.text()},
          {"references", references.json()}, {"roadS", road_s.text()}};
}

std::string_view to_string(JunctionKind kind) {
  switch (kind) {
    case JunctionKind::common:
      return "common";
    case JunctionKind::direct:
      return "direct";
    case JunctionKind::virtual_:
      return "virtual";
    case JunctionKind::crossing:
      return "crossing";
  }
  return "common";
}

Json junctions_json(const RoadMap& road_map) {
  Json made = Json::array();
  for (const Junction& junction : road_map.junctions()) {
    made.push_back(
        {{"id", junction.source_id}, {"name", junction.name}, {"type", to_string(junction.kind)}});
  }
  return made;
}

Json signals_json(const RoadMap& road_map) {
  Json made = Json::array();
  for (const Signal& signal : road_map.signals()) {
    Json one = {{"id", signal.source_id}, {"name", signal.name}, {"at", place_json(signal.in_map)}};
    one["road"] = index_of(signal.road);
    if (signal.road) one["on"] = {rounded(signal.road_s_m), rounded(signal.road_t_m)};
    one["z"] = rounded(signal.z_m);
    if (signal.heading_rad) one["heading"] = rounded(*signal.heading_rad);
    one["type"] = signal.type;
    one["subtype"] = signal.subtype;
    one["country"] = signal.country;
    if (signal.value) one["value"] = fmt::format("{} {}", *signal.value, signal.unit);
    if (!signal.text.empty()) one["text"] = signal.text;
    one["dynamic"] = signal.dynamic;
    one["lanes"] = indices(signal.lanes);
    one["attributes"] = attribute_lines(signal.attributes);
    made.push_back(std::move(one));
  }
  return made;
}

Json objects_json(const RoadMap& road_map) {
  Json list = Json::array();
  LineColumns outlines;
  for (const MapObject& object : road_map.objects()) {
    list.push_back({{"id", object.source_id},
                    {"name", object.name},
                    {"type", object.type},
                    {"at", place_json(object.in_map)},
                    {"road", index_of(object.road)},
                    {"on", {rounded(object.road_s_m), rounded(object.road_t_m)}},
                    {"height", rounded(object.height_m)},
                    {"attributes", attribute_lines(object.attributes)}});
    outlines.add(object.outline_in_map);
  }
  return {{"list", std::move(list)}, {"outlines", outlines.json()}};
}

Json stop_lines_json(const RoadMap& road_map) {
  Json list = Json::array();
  LineColumns lines;
  for (const StopLine& line : road_map.stop_lines()) {
    list.push_back(
        {{"id", line.source_id}, {"lanes", indices(line.lanes)}, {"signals", line.signals}});
    lines.add(flat(line.in_map));
  }
  return {{"list", std::move(list)}, {"lines", lines.json()}};
}

Json regulations_json(const RoadMap& road_map) {
  Json made = Json::array();
  for (const Regulation& regulation : road_map.regulations()) {
    Json members = Json::array();
    for (const RegulationMember& member : regulation.members) {
      members.push_back({member.role, member.source_id, index_of(member.lane)});
    }
    made.push_back({{"id", regulation.source_id},
                    {"type", regulation.type},
                    {"lanes", indices(regulation.lanes)},
                    {"members", std::move(members)},
                    {"attributes", attribute_lines(regulation.attributes)}});
  }
  return made;
}

Json areas_json(const RoadMap& road_map) {
  Json list = Json::array();
  LineColumns rings;
  for (const Area& area : road_map.areas()) {
    std::size_t count = 0;
    for (const geometry::Polygon& polygon : area.in_map) {
      rings.add(polygon.outer);
      for (const geometry::Ring& hole : polygon.holes) rings.add(hole);
      count += 1 + polygon.holes.size();
    }
    list.push_back({{"id", area.source_id},
                    {"type", area.type},
                    {"isRoad", area.is_road},
                    {"rings", count},
                    {"attributes", attribute_lines(area.attributes)}});
  }
  return {{"list", std::move(list)}, {"rings", rings.json()}};
}

}  // namespace

std::string attribute_lines(const Attributes& attributes) {
  std::string lines;
  for (const auto& [key, value] : attributes) {
    lines += fmt::format("{}{}={}", lines.empty() ? "" : "\n", key, value);
  }
  return lines;
}

Json things_json(const RoadMap& road_map) {
  return {{"roads", roads_json(road_map)},          {"junctions", junctions_json(road_map)},
          {"signals", signals_json(road_map)},      {"objects", objects_json(road_map)},
          {"stopLines", stop_lines_json(road_map)}, {"regulations", regulations_json(road_map)},
          {"areas", areas_json(road_map)}};
}

Json remarks_json(const std::vector<PageRemark>& remarks) {
  Json made = Json::array();
  for (const PageRemark& remark : remarks) {
    made.push_back({{"rule", remark.rule},
                    {"severity", remark.severity},
                    {"element", remark.element},
                    {"line", remark.line},
                    {"at", remark.in_map ? place_json(*remark.in_map) : Json()},
                    {"message", remark.message}});
  }
  return made;
}

Json overlays_json(const std::vector<PageOverlay>& overlays) {
  Json made = Json::array();
  for (const PageOverlay& overlay : overlays) {
    LineColumns lines, rings, boxes;
    for (const auto& line : overlay.lines_in_map) lines.add(line);
    for (const auto& ring : overlay.rings_in_map) rings.add(ring);
    for (const auto& box : overlay.boxes_in_map) boxes.add(std::array{box.min(), box.max()});
    Json pieces = Json::array();
    for (const PagePiece& piece : overlay.pieces) {
      pieces.push_back({{"lane", piece.lane.index},
                        {"from", rounded(piece.from_s_m)},
                        {"to", rounded(piece.to_s_m)}});
    }
    made.push_back({{"kind", overlay.kind},
                    {"name", overlay.name},
                    {"text", overlay.text},
                    {"isAlternative", overlay.is_alternative},
                    {"pieces", std::move(pieces)},
                    {"lines", lines.json()},
                    {"rings", rings.json()},
                    {"boxes", boxes.json()}});
  }
  return made;
}

}  // namespace roadbed::map::page
