#include "roadbed/map/lanelet2/osm_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::lanelet2 {
namespace {

std::optional<std::int64_t> writable_id(const std::string& text) {
  constexpr std::int64_t largest = 9'200'000'000'000'000'000;  // and 2·10¹⁶ fresh ones beyond
  const std::optional<std::int64_t> id = id_in(text);
  return id && *id > 0 && *id <= largest ? id : std::nullopt;
}

// Larger than every number that the map's things are named by.
std::int64_t beyond_all_ids(const RoadMap& road_map) {
  std::int64_t largest = 0;
  const auto see = [&](const std::string& text) {
    largest = std::max(largest, writable_id(text).value_or(0));
  };
  for (const Lane& lane : road_map.lanes()) see(lane.name);
  for (const Regulation& regulation : road_map.regulations()) {
    see(regulation.source_id);
    for (const RegulationMember& member : regulation.members) see(member.source_id);
  }
  for (const Signal& signal : road_map.signals()) see(signal.source_id);
  for (const StopLine& line : road_map.stop_lines()) see(line.source_id);
  for (const Area& area : road_map.areas()) see(area.source_id);
  for (const MapObject& object : road_map.objects()) see(object.source_id);
  return largest + 1;
}

void append_tags(const Attributes& tags, std::string& text) {
  for (const auto& [key, value] : tags) {
    fmt::format_to(std::back_inserter(text), "    <tag k=\"{}\" v=\"{}\"/>\n", xml_text(key),
                   xml_text(value));
  }
}

}  // namespace

OsmText::OsmText(const RoadMap& road_map, std::string crs, const CrsOffset& offset,
                 const TransverseMercator& grid)
    : road_map_(road_map),
      crs_(std::move(crs)),
      offset_(offset),
      grid_(grid),
      next_(beyond_all_ids(road_map)) {}

std::int64_t OsmText::keep(const std::string& source_id) {
  const std::optional<std::int64_t> id = writable_id(source_id);
  return id && taken_.insert(*id).second ? *id : fresh();
}

std::int64_t OsmText::add_node(const Eigen::Vector3d& in_map) {
  const std::int64_t id = fresh();
  const Eigen::Vector2d at = road_map_.to_source(in_map.head<2>());
  const geometry::Pose2 crs_from_source{offset_.x_m, offset_.y_m, offset_.heading_rad};
  const GeographicPoint place = grid_.inverse(crs_from_source * at);
  fmt::format_to(std::back_inserter(nodes_),
                 "  <node id=\"{}\" lat=\"{:.12f}\" lon=\"{:.12f}\">\n"
                 "    <tag k=\"local_x\" v=\"{:.6f}\"/>\n    <tag k=\"local_y\" v=\"{:.6f}\"/>\n"
                 "    <tag k=\"ele\" v=\"{:.4f}\"/>\n  </node>\n",
                 id, place.latitude_deg, place.longitude_deg, at.x(), at.y(),
                 in_map.z() + offset_.z_m);
  return id;
}

void OsmText::add_way(std::int64_t id, const std::vector<std::int64_t>& nodes,
                      const Attributes& tags) {
  fmt::format_to(std::back_inserter(ways_), "  <way id=\"{}\">\n", id);
  for (const std::int64_t node : nodes) {
    fmt::format_to(std::back_inserter(ways_), "    <nd ref=\"{}\"/>\n", node);
  }
  append_tags(tags, ways_);
  ways_ += "  </way>\n";
}

void OsmText::add_relation(std::int64_t id, const std::string& members, const Attributes& tags) {
  fmt::format_to(std::back_inserter(relations_), "  <relation id=\"{}\">\n{}", id, members);
  append_tags(tags, relations_);
  relations_ += "  </relation>\n";
}

std::string OsmText::member(const char* kind, std::int64_t id, std::string_view role) {
  return fmt::format("    <member type=\"{}\" ref=\"{}\" role=\"{}\"/>\n", kind, id,
                     xml_text(role));
}

std::string OsmText::file() const {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<osm version=\"0.6\" generator=\"roadbed\"";
  if (offset_ == CrsOffset{}) text += fmt::format(" crs=\"{}\"", xml_text(crs_));
  return text + ">\n" + nodes_ + ways_ + relations_ + "</osm>\n";
}

}  // namespace roadbed::map::lanelet2
