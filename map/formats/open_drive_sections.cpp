#include "roadbed/map/formats/open_drive_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "roadbed/map/formats/open_drive_values.h"

namespace roadbed::map::open_drive {
namespace {

std::vector<int> read_lane_ids(const XmlDocument& xml, pugi::xml_node link, const char* name) {
  std::vector<int> ids;
  for (const auto node : link.children(name)) ids.push_back(xml.integer(node, "id"));
  return ids;
}

LaneRecord read_lane(const XmlDocument& xml, pugi::xml_node node, double section_s_m) {
  LaneRecord lane;
  lane.id = xml.integer(node, "id");
  lane.type = lane_type(node.attribute("type").value());
  lane.direction = node.attribute("direction").value();
  lane.line = xml.line_of(node);
  lane.predecessors = read_lane_ids(xml, node.child("link"), "predecessor");
  lane.successors = read_lane_ids(xml, node.child("link"), "successor");
  lane.width = read_cubics(xml, node, "width", "sOffset", section_s_m);
  if (lane.width.empty()) lane.border = read_cubics(xml, node, "border", "sOffset", section_s_m);
  for (const auto mark : node.children("roadMark")) {
    lane.marks.push_back({xml.number_or(mark, "sOffset", 0.0), mark.attribute("type").value(),
                          mark.attribute("laneChange").value()});
  }
  for (const auto speed : node.children("speed")) {
    lane.speeds.push_back({xml.number_or(speed, "sOffset", 0.0), read_speed(xml, speed)});
  }
  for (const auto height : node.children("height")) {
    lane.heights.push_back({xml.number_or(height, "sOffset", 0.0),
                            xml.number_or(height, "inner", 0.0),
                            xml.number_or(height, "outer", 0.0)});
  }
  return lane;
}

void read_side(const XmlDocument& xml, pugi::xml_node side, LaneSection& section) {
  for (const auto node : side.children("lane")) {
    LaneRecord lane = read_lane(xml, node, section.s_m);
    const int id = lane.id;
    if (!section.lanes.emplace(id, std::move(lane)).second) {
      xml.refuse(node, fmt::format("a second lane {} in one lane section", id),
                 "unique lane ids within a section", "give one of them another id");
    }
  }
}

LaneSection read_section(const XmlDocument& xml, pugi::xml_node node) {
  LaneSection section;
  section.s_m = xml.number(node, "s");
  section.line = xml.line_of(node);
  const std::string_view single = node.attribute("singleSide").value();
  section.single_side = single == "true" || single == "1";
  for (const char* side : {"left", "center", "right"}) read_side(xml, node.child(side), section);
  return section;
}

}  // namespace

std::vector<LaneSection> read_sections(const XmlDocument& xml, pugi::xml_node lanes,
                                       const RoadRecord& road, std::vector<ImportRemark>& remarks) {
  std::vector<LaneSection> sections;
  for (const auto node : lanes.children("laneSection")) {
    sections.push_back(read_section(xml, node));
  }
  std::stable_sort(sections.begin(), sections.end(),
                   [](const auto& a, const auto& b) { return a.s_m < b.s_m; });
  if (sections.empty()) {
    remarks.push_back({"import.no-lanes", true, "road " + road.id, road.line,
                       "has no lane section and gives no lane"});
  }
  return sections;
}

}  // namespace roadbed::map::open_drive
