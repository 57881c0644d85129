#include "roadbed/map/lanelet2/write/osm_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "roadbed/map/files/xml_characters.h"

namespace roadbed::map::lanelet2 {
namespace {

std::optional<std::int64_t> writable_id(const std::string& text) {
  const std::optional<std::int64_t> id = id_in(text);
  return id && *id > 0 && *id <= kLargestKeptId ? id : std::nullopt;
}

void append_tag(std::string_view key, std::string_view value, std::string& text) {
  fmt::format_to(std::back_inserter(text), "    <tag k=\"{}\" v=\"{}\"/>\n",
                 xml_text(std::string(key)), xml_text(std::string(value)));
}

void append_tags(const Attributes& tags, std::string& text) {
  for (const auto& [key, value] : tags) append_tag(key, value, text);
}

void append_node(const OsmNode& node, const OsmPlace& place, double z_offset_m, std::string& text) {
  fmt::format_to(std::back_inserter(text), "  <node id=\"{}\" lat=\"{:.12f}\" lon=\"{:.12f}\">\n",
                 node.id, place.on_earth.latitude_deg, place.on_earth.longitude_deg);
  if (!place.mgrs_code.empty()) append_tag("mgrs_code", place.mgrs_code, text);
  fmt::format_to(std::back_inserter(text),
                 "    <tag k=\"local_x\" v=\"{:.6f}\"/>\n    <tag k=\"local_y\" v=\"{:.6f}\"/>\n"
                 "    <tag k=\"ele\" v=\"{:.4f}\"/>\n",
                 place.local.x(), place.local.y(), node.in_map.z() + z_offset_m);
  append_tags(node.tags, text);
  text += "  </node>\n";
}

void append_way(const OsmMap& osm, const OsmWay& way, std::string& text) {
  fmt::format_to(std::back_inserter(text), "  <way id=\"{}\">\n", way.id);
  for (const std::uint32_t node : way.nodes) {
    fmt::format_to(std::back_inserter(text), "    <nd ref=\"{}\"/>\n", osm.nodes[node].id);
  }
  append_tags(way.tags, text);
  text += "  </way>\n";
}

std::pair<const char*, std::int64_t> named(const OsmMap& osm, const OsmMember& member) {
  switch (member.kind) {
    case MemberKind::node:
      return {"node", osm.nodes[member.index].id};
    case MemberKind::way:
      return {"way", osm.ways[member.index].id};
    case MemberKind::relation:
      break;
  }
  return {"relation", osm.relations[member.index].id};
}

void append_relation(const OsmMap& osm, const OsmRelation& relation, std::string& text) {
  fmt::format_to(std::back_inserter(text), "  <relation id=\"{}\">\n", relation.id);
  for (const OsmMember& member : relation.members) {
    const auto [kind, id] = named(osm, member);
    fmt::format_to(std::back_inserter(text), "    <member type=\"{}\" ref=\"{}\" role=\"{}\"/>\n",
                   kind, id, xml_text(member.role));
  }
  append_tags(relation.tags, text);
  text += "  </relation>\n";
}

template <typename Tags>
auto find_tag(Tags& tags, std::string_view key) {
  return std::ranges::find_if(tags, [&](const auto& tag) { return tag.first == key; });
}

template <typename List, typename Element>
std::uint32_t appended(List& list, Element element) {
  list.push_back(std::move(element));
  return static_cast<std::uint32_t>(list.size() - 1);
}

}  // namespace

std::int64_t OsmMap::keep(const std::string& source_id) {
  const std::optional<std::int64_t> id = writable_id(source_id);
  return id && taken_.insert(*id).second ? *id : fresh();
}

std::uint32_t OsmMap::add_node(const Eigen::Vector3d& in_map, Attributes tags) {
  return appended(nodes, OsmNode{fresh(), in_map, std::move(tags)});
}

std::uint32_t OsmMap::add_way(std::vector<std::uint32_t> of_nodes, Attributes tags,
                              std::int64_t id) {
  return appended(ways, OsmWay{id, std::move(of_nodes), std::move(tags)});
}

std::uint32_t OsmMap::add_relation(std::vector<OsmMember> members, Attributes tags,
                                   std::int64_t id) {
  return appended(relations, OsmRelation{id, std::move(members), std::move(tags)});
}

std::vector<Eigen::Vector3d> OsmMap::points(std::uint32_t way) const {
  std::vector<Eigen::Vector3d> points;
  points.reserve(ways[way].nodes.size());
  for (const std::uint32_t node : ways[way].nodes) points.push_back(nodes[node].in_map);
  return points;
}

std::int64_t id_beyond_all(const RoadMap& road_map) {
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

std::string_view tag_of(const Attributes& tags, std::string_view key) {
  const auto found = find_tag(tags, key);
  return found == tags.end() ? std::string_view() : found->second;
}

void set_tag(Attributes& tags, std::string_view key, std::string_view value) {
  const auto found = find_tag(tags, key);
  if (found == tags.end()) {
    tags.emplace_back(key, value);
  } else {
    found->second = value;
  }
}

void remove_tag(Attributes& tags, std::string_view key) {
  std::erase_if(tags, [&](const auto& tag) { return tag.first == key; });
}

std::string osm_text(const OsmMap& osm, const OsmFrame& frame,
                     const std::function<OsmPlace(std::size_t)>& place_of) {
  std::string text;
  text.reserve(400 * (osm.nodes.size() + 100));  // what is not written to takes no memory
  text +=
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<osm version=\"0.6\" upload=\"never\" generator=\"roadbed\"";
  if (!frame.crs.empty()) text += fmt::format(" crs=\"{}\"", xml_text(frame.crs));
  text += ">\n";
  if (frame.with_versions) text += "  <MetaInfo format_version=\"1\" map_version=\"1\"/>\n";
  for (std::size_t i = 0; i < osm.nodes.size(); ++i) {
    append_node(osm.nodes[i], place_of(i), frame.z_offset_m, text);
  }
  for (const OsmWay& way : osm.ways) append_way(osm, way, text);
  for (const OsmRelation& relation : osm.relations) append_relation(osm, relation, text);
  text += "</osm>\n";
  return text;
}

}  // namespace roadbed::map::lanelet2
