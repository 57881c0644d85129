#include "roadbed/map/formats/write_geojson.h"

#include <nlohmann/json.hpp>
#include <vector>

namespace roadbed::map {
namespace {

using Json = nlohmann::ordered_json;

/// Names of sources are not always valid UTF-8; JSON has to be.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json position(const RoadMap& road_map, const Eigen::Vector2d& in_map) {
  const Eigen::Vector2d in_source = road_map.to_source(in_map);
  return {in_source.x(), in_source.y()};
}

Json feature(Json geometry, Json properties) {
  return {{"type", "Feature"},
          {"geometry", std::move(geometry)},
          {"properties", std::move(properties)}};
}

template <typename Ids>
Json names_of(const RoadMap& road_map, const Ids& lanes) {
  Json names = Json::array();
  for (const LaneId id : lanes) names.push_back(road_map.lane(id).name);
  return names;
}

Json neighbour_name(const RoadMap& road_map, const std::optional<Neighbour>& neighbour) {
  return neighbour ? Json(road_map.lane(neighbour->lane).name) : Json();
}

Json lane_properties(const RoadMap& road_map, const Lane& lane, const char* kind) {
  Json properties = {{"kind", kind}, {"lane", lane.name}};
  properties["road"] = lane.road ? Json(road_map.road(*lane.road).source_id) : Json();
  properties["section"] = lane.origin.section;
  properties["junction"] =
      lane.junction ? Json(road_map.junction(*lane.junction).source_id) : Json();
  properties["type"] = name(lane.type);
  properties["length_m"] = lane.length_m();
  const auto limit_mps = lane.least_speed_limit_mps();
  properties["speed_limit_mps"] = limit_mps ? Json(*limit_mps) : Json();
  return properties;
}

Json lane_feature(const RoadMap& road_map, const Lane& lane) {
  Json ring = Json::array();
  for (const auto& point : lane.polygon) ring.push_back(position(road_map, point));
  if (!lane.polygon.empty()) ring.push_back(position(road_map, lane.polygon.front()));
  Json properties = lane_properties(road_map, lane, "lane");
  properties["area_m2"] = geometry::signed_area_m2(lane.polygon);
  const LaneLinks& links = road_map.graph().of(lane.id);
  properties["successors"] = names_of(road_map, links.successors);
  properties["predecessors"] = names_of(road_map, links.predecessors);
  properties["left"] = neighbour_name(road_map, links.left);
  properties["right"] = neighbour_name(road_map, links.right);
  if (lane.polygon.empty()) return feature(nullptr, std::move(properties));
  return feature({{"type", "Polygon"}, {"coordinates", Json::array({std::move(ring)})}},
                 std::move(properties));
}

Json centreline_feature(const RoadMap& road_map, const Lane& lane) {
  Json line = Json::array();
  const auto& points = lane.centre.in_map.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    Json at = position(road_map, points[i]);
    at.push_back(lane.centre.z_m[i]);
    line.push_back(std::move(at));
  }
  return feature({{"type", "LineString"}, {"coordinates", std::move(line)}},
                 lane_properties(road_map, lane, "centreline"));
}

Json signal_feature(const RoadMap& road_map, const Signal& signal) {
  Json properties = {{"kind", "signal"},
                     {"signal", signal.source_id},
                     {"name", signal.name},
                     {"road", signal.road ? Json(road_map.road(*signal.road).source_id) : Json()},
                     {"dynamic", signal.dynamic},
                     {"country", signal.country},
                     {"type", signal.type},
                     {"subtype", signal.subtype}};
  properties["value"] = signal.value ? Json(*signal.value) : Json();
  properties["unit"] = signal.unit;
  properties["lanes"] = names_of(road_map, signal.lanes);
  return feature({{"type", "Point"}, {"coordinates", position(road_map, signal.in_map)}},
                 std::move(properties));
}

Json crs_member(const std::string& crs) {
  if (crs.empty()) return nullptr;
  return {{"type", "name"}, {"properties", {{"name", crs}}}};
}

}  // namespace

std::string write_geojson(const RoadMap& road_map) {
  std::string text =
      "{\"type\":\"FeatureCollection\",\n\"crs\":" + text_of(crs_member(road_map.crs())) +
      ",\n\"source_format\":" + text_of(road_map.format()) + ",\n\"features\":[";
  std::string separator = "\n";
  const auto add = [&](const Json& json) {
    text += separator + text_of(json);
    separator = ",\n";
  };
  for (const Lane& lane : road_map.lanes()) {
    add(lane_feature(road_map, lane));
    add(centreline_feature(road_map, lane));
  }
  for (const Signal& signal : road_map.signals()) add(signal_feature(road_map, signal));
  return text + "\n]}\n";
}

}  // namespace roadbed::map
