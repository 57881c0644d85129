#include "roadbed/map/opendrive/roads.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "roadbed/map/opendrive/objects.h"
#include "roadbed/map/opendrive/plan_view.h"
#include "roadbed/map/opendrive/sections.h"
#include "roadbed/map/opendrive/signals.h"
#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive {
namespace {

void read_crossfall(const XmlDocument& xml, pugi::xml_node lateral, RoadRecord& road) {
  std::vector<geometry::CubicRecord> left, right;
  for (const auto node : lateral.children("crossfall")) {
    const std::string_view side = node.attribute("side").value();
    const geometry::CubicRecord record = read_cubic(xml, node, "s", 0.0);
    if (side != "right") left.push_back(record);
    if (side != "left") right.push_back(record);
  }
  road.crossfall_left = geometry::PiecewiseCubic(sorted(std::move(left)));
  road.crossfall_right = geometry::PiecewiseCubic(sorted(std::move(right)));
}

// Cubics over t, gathered by their station.
LateralShape read_shape(const XmlDocument& xml, pugi::xml_node lateral) {
  std::vector<std::pair<double, geometry::CubicRecord>> records;
  for (const auto node : lateral.children("shape")) {
    records.emplace_back(xml.number(node, "s"), read_cubic(xml, node, "t", 0.0));
  }
  std::stable_sort(records.begin(), records.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first, a.second.s_m) < std::pair(b.first, b.second.s_m);
  });
  std::vector<LateralShape::Profile> profiles;
  for (auto from = records.begin(); from != records.end();) {
    const auto to = std::find_if(from, records.end(),
                                 [&](const auto& record) { return record.first != from->first; });
    std::vector<geometry::CubicRecord> over_t;
    std::transform(from, to, std::back_inserter(over_t), [](const auto& r) { return r.second; });
    profiles.push_back({from->first, geometry::PiecewiseCubic(std::move(over_t))});
    from = to;
  }
  return LateralShape(std::move(profiles));
}

void read_profiles(const XmlDocument& xml, pugi::xml_node node, RoadRecord& road) {
  const auto lateral = node.child("lateralProfile");
  road.elevation = read_cubics(xml, node.child("elevationProfile"), "elevation", "s", 0.0);
  road.superelevation = read_cubics(xml, lateral, "superelevation", "s", 0.0);
  road.lane_offset = read_cubics(xml, node.child("lanes"), "laneOffset", "s", 0.0);
  read_crossfall(xml, lateral, road);
  road.shape = read_shape(xml, lateral);
}

void read_speeds(const XmlDocument& xml, pugi::xml_node node, RoadRecord& road,
                 std::vector<ImportRemark>& remarks) {
  for (const auto type : node.children("type")) {
    road.speeds.push_back(
        {xml.number_or(type, "s", 0.0), read_speed(xml, type.child("speed"), remarks)});
  }
  std::stable_sort(road.speeds.begin(), road.speeds.end(),
                   [](const auto& a, const auto& b) { return a.s_m < b.s_m; });
}

RoadRecord read_road(const XmlDocument& xml, pugi::xml_node node, Document& document) {
  RoadRecord road;
  road.line = xml.line_of(node);
  road.id = xml.text(node, "id");
  road.name = node.attribute("name").value();
  road.length_m = xml.number(node, "length");
  if (road.length_m > kLongestRoadM) {
    xml.refuse(node, fmt::format("length {} m", road.length_m), "at most 1e6 m",
               "correct the length");
  }
  const std::string_view junction = node.attribute("junction").value();
  if (junction != "-1") road.junction_id = junction;
  road.left_hand_traffic = std::string_view(node.attribute("rule").value()) == "LHT";
  road.predecessor = read_road_link(xml, node.child("link").child("predecessor"));
  road.successor = read_road_link(xml, node.child("link").child("successor"));
  read_speeds(xml, node, road, document.remarks);
  read_plan_view(xml, node, road, document);
  read_profiles(xml, node, road);
  road.sections = read_sections(xml, node.child("lanes"), road, document);
  read_signals(xml, node.child("signals"), road, document.remarks);
  read_objects(xml, node.child("objects"), road, document.remarks);
  return road;
}

}  // namespace

std::optional<RoadLink> read_road_link(const XmlDocument& xml, pugi::xml_node node) {
  if (!node) return {};
  RoadLink link;
  link.to_junction = std::string_view(node.attribute("elementType").value()) == "junction";
  link.element_id = node.attribute("elementId").value();
  const std::string_view contact = node.attribute("contactPoint").value();
  if (contact == "start") link.contact = ContactPoint::start;
  if (contact == "end") link.contact = ContactPoint::end;
  if (!link.contact && !link.to_junction) link.element_s_m = xml.optional_number(node, "elementS");
  link.element_forward = std::string_view(node.attribute("elementDir").value()) != "-";
  return link;
}

void read_roads(const XmlDocument& xml, Document& document) {
  std::set<std::string> seen;
  for (const auto node : xml.root().children("road")) {
    if (!seen.insert(xml.text(node, "id")).second) {
      document.remarks.push_back({"import.duplicate-road", true, XmlDocument::place_of(node),
                                  xml.line_of(node),
                                  "has the id of a road before it and is left out, as links could "
                                  "mean either; give it another id"});
      continue;
    }
    RoadRecord road = read_road(xml, node, document);
    if (road.plan_pieces.empty() || !(road.length_m > 0.0)) {
      document.remarks.push_back({"import.no-geometry", true, "road " + road.id, road.line,
                                  "has no plan view of positive length and is left out"});
      continue;
    }
    document.roads.push_back(std::move(road));
  }
  if (document.roads.empty()) {
    xml.refuse(xml.root(), "no road with a geometry", "at least one road",
               "check whether the file is complete");
  }
}

}  // namespace roadbed::map::opendrive
