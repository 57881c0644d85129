#include "roadbed/map/opendrive/signals.h"

#include <string_view>

#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive {
namespace {

void read_position(const XmlDocument& xml, pugi::xml_node node, SignalRecord& signal) {
  if (const auto place = node.child("positionInertial")) {
    signal.inertial = {xml.number(place, "x"), xml.number(place, "y"), xml.number(place, "z"),
                       xml.number_or(place, "hdg", 0.0)};
  }
  if (const auto place = node.child("positionRoad")) {
    signal.on_road = {place.attribute("roadId").value(), xml.number(place, "s"),
                      xml.number(place, "t"), xml.number_or(place, "zOffset", 0.0),
                      xml.number_or(place, "hOffset", 0.0)};
  }
}

void keep_words(pugi::xml_node node, SignalRecord& signal) {
  keep_attributes(
      node,
      {"orientation", "countryRevision", "height", "width", "length", "pitch", "roll", "temporary"},
      signal.attributes);
  for (const auto child : node.children("dependency")) {
    signal.dependencies.emplace_back(child.attribute("id").value());
    signal.attributes.emplace_back("dependency", described(child));
  }
  for (const auto child : node.children("reference")) {
    signal.attributes.emplace_back("reference", described(child));
  }
}

SignalRecord read_signal(const XmlDocument& xml, pugi::xml_node node) {
  SignalRecord signal;
  signal.id = node.attribute("id").value();
  signal.name = node.attribute("name").value();
  signal.s_m = xml.number(node, "s");
  signal.t_m = xml.number_or(node, "t", 0.0);
  signal.z_offset_m = xml.number_or(node, "zOffset", 0.0);
  signal.heading_offset_rad = xml.number_or(node, "hOffset", 0.0);
  signal.width_m = xml.optional_number(node, "width").value_or(0.0);
  signal.country = node.attribute("country").value();
  signal.type = node.attribute("type").value();
  signal.subtype = node.attribute("subtype").value();
  signal.unit = node.attribute("unit").value();
  signal.text = node.attribute("text").value();
  signal.value = xml.optional_number(node, "value");
  signal.dynamic = std::string_view(node.attribute("dynamic").value()) == "yes";
  signal.orientation = orientation_of(node.attribute("orientation").value());
  signal.lanes = read_lane_ranges(xml, node);
  read_position(xml, node, signal);
  keep_words(node, signal);
  return signal;
}

SignalReference read_reference(const XmlDocument& xml, pugi::xml_node node) {
  return {node.attribute("id").value(),  xml.number(node, "s"),
          xml.number_or(node, "t", 0.0), orientation_of(node.attribute("orientation").value()),
          read_lane_ranges(xml, node),   xml.line_of(node)};
}

}  // namespace

void read_signals(const XmlDocument& xml, pugi::xml_node signals, RoadRecord& road,
                  std::vector<ImportRemark>& remarks) {
  for (const auto node : signals.children("signal")) {
    read_or_remark("import.signal", remarks,
                   [&] { road.signals.push_back(read_signal(xml, node)); });
  }
  for (const auto node : signals.children("signalReference")) {
    read_or_remark("import.signal", remarks,
                   [&] { road.signal_references.push_back(read_reference(xml, node)); });
  }
}

}  // namespace roadbed::map::opendrive
