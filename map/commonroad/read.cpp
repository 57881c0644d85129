#include "roadbed/map/commonroad/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "roadbed/map/commonroad/build_map.h"
#include "roadbed/map/commonroad/values.h"
#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::commonroad {
namespace {

/// Children of <commonRoad> and <lanelet> that are read; all others are counted as unused.
constexpr std::array<std::string_view, 12> kUsedOfFile = {"lanelet",
                                                          "trafficSign",
                                                          "trafficLight",
                                                          "intersection",
                                                          "location",
                                                          "scenarioTags",
                                                          "obstacle",
                                                          "staticObstacle",
                                                          "dynamicObstacle",
                                                          "planningProblem",
                                                          "environmentObstacle",
                                                          "phantomObstacle"};
constexpr std::array<std::string_view, 13> kUsedOfLanelet = {
    "leftBound",     "rightBound",     "predecessor",    "successor",  "adjacentLeft",
    "adjacentRight", "stopLine",       "laneletType",    "userOneWay", "userBidirectional",
    "speedLimit",    "trafficSignRef", "trafficLightRef"};

template <std::size_t N>
void count_unused(pugi::xml_node parent, const std::array<std::string_view, N>& used,
                  std::map<std::string, std::size_t>& counts) {
  for (const pugi::xml_node child : parent.children()) {
    if (child.type() != pugi::node_element) continue;
    if (std::find(used.begin(), used.end(), child.name()) != used.end()) continue;
    ++counts[fmt::format("{}/{}", parent.name(), child.name())];
  }
}

std::vector<UnusedContent> unused_content(pugi::xml_node root) {
  std::map<std::string, std::size_t> counts;
  count_unused(root, kUsedOfFile, counts);
  for (const pugi::xml_node lanelet : root.children("lanelet")) {
    count_unused(lanelet, kUsedOfLanelet, counts);
  }
  std::vector<UnusedContent> unused;
  for (const auto& [name, count] : counts) unused.push_back({name, count});
  return unused;
}

/// What the header and the location say.
Attributes file_attributes(pugi::xml_node root) {
  Attributes attributes;
  for (const pugi::xml_attribute attribute : root.attributes()) {
    attributes.emplace_back(attribute.name(), attribute.value());
  }
  const pugi::xml_node location = root.child("location");
  for (const char* child : {"geoNameId", "gpsLatitude", "gpsLongitude"}) {
    if (location.child(child)) attributes.emplace_back(child, text_of(location.child(child)));
  }
  const pugi::xml_node extra =
      location.child("geoTransformation").child("additionalTransformation");
  if (extra.child("scaling")) attributes.emplace_back("scaling", text_of(extra.child("scaling")));
  return attributes;
}

/// Where the map's coordinates are in its system: turned, then moved there, as CommonRoad's own
/// converters take it.
CrsOffset offset_of(const XmlDocument& xml, std::vector<ImportDiagnostic>& remarks) {
  const pugi::xml_node transformation = xml.root().child("location").child("geoTransformation");
  const pugi::xml_node extra = transformation.child("additionalTransformation");
  const auto number = [&](const char* name, double otherwise) {
    const pugi::xml_node part = extra.child(name);
    if (!part) return otherwise;
    const std::string text = text_of(part);
    double value = 0.0;
    const char* const end = text.data() + text.size();
    const auto [rest, fault] = std::from_chars(text.data(), end, value);
    if (fault == std::errc() && rest == end && std::isfinite(value)) return value;
    remarks.push_back(
        {"import.geo-transformation", true, std::string(name), 0,
         fmt::format("is \"{}\", no number; {} is taken", one_line(text), otherwise)});
    return otherwise;
  };
  const CrsOffset offset{.x_m = number("xTranslation", 0.0),
                         .y_m = number("yTranslation", 0.0),
                         .heading_rad = number("zRotation", 0.0)};
  if (const double scaling = number("scaling", 1.0); scaling != 1.0) {
    remarks.push_back({"import.geo-transformation", true, "scaling", 0,
                       fmt::format("is {}: the map stays as large as it is", scaling)});
  }
  return offset;
}

std::string format_name(const XmlDocument& xml) {
  const std::string version = xml.root().attribute("commonRoadVersion").value();
  if (version != "2018b" && version != "2020a") {
    xml.refuse(xml.root(), fmt::format("commonRoadVersion=\"{}\"", version), "2018b or 2020a",
               "convert the file to 2020a with commonroad-io");
  }
  return "CommonRoad " + version;
}

}  // namespace

RoadMapParts read(const Document& document) {
  const XmlDocument& xml = document.xml;
  RoadMapParts parts;
  parts.format = format_name(xml);
  parts.origin_in_source = find_origin(xml);
  parts.attributes = file_attributes(xml.root());
  parts.crs =
      text_of(xml.root().child("location").child("geoTransformation").child("geoReference"));
  parts.offset_in_crs = offset_of(xml, parts.remarks);
  parts.unused = unused_content(xml.root());
  BuiltLanes built = build_lanes(document, parts.origin_in_source, parts.remarks);
  if (built.lanes.empty()) {
    xml.refuse(xml.root(), "no usable lanelet", "at least one", "check whether it holds a map");
  }
  const std::string country = country_of(xml.root().attribute("benchmarkID").value());
  add_rules(document, country, built, parts);
  parts.links = link_lanes(document, built, parts.remarks);
  parts.lanes = std::move(built.lanes);
  return parts;
}

}  // namespace roadbed::map::commonroad
