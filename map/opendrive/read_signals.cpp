#include "roadbed/map/opendrive/element_readers.h"

#include <string_view>

#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive {
namespace {

void read_position(AttributeReader& in, pugi::xml_node node, SignalRecord& signal) {
  if (const auto place = node.child("positionInertial")) {
    signal.inertial = {in.number(place, "x"), in.number(place, "y"), in.number(place, "z"),
                       in.number_or(place, "hdg", 0.0)};
  }
  if (const auto place = node.child("positionRoad")) {
    signal.on_road = {place.attribute("roadId").value(), in.number(place, "s"),
                      in.number(place, "t"), in.number_or(place, "zOffset", 0.0),
                      in.number_or(place, "hOffset", 0.0)};
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

void read_signal(AttributeReader& in, SignalRecord& signal) {
  const pugi::xml_node node = signal.node;
  signal.id = node.attribute("id").value();
  signal.name = node.attribute("name").value();
  signal.s_m = in.number(node, "s");
  signal.t_m = in.number_or(node, "t", 0.0);
  signal.z_offset_m = in.number_or(node, "zOffset", 0.0);
  signal.heading_offset_rad = in.number_or(node, "hOffset", 0.0);
  signal.width_m = in.xml.optional_number(node, "width").value_or(0.0);
  signal.country = node.attribute("country").value();
  signal.type = node.attribute("type").value();
  signal.subtype = node.attribute("subtype").value();
  signal.unit = node.attribute("unit").value();
  signal.text = node.attribute("text").value();
  signal.value = in.xml.optional_number(node, "value");
  signal.dynamic = std::string_view(node.attribute("dynamic").value()) == "yes";
  signal.orientation = orientation_of(node.attribute("orientation").value());
  signal.lanes = read_lane_ranges(in, node);
  read_position(in, node, signal);
  keep_words(node, signal);
}

void read_reference(AttributeReader& in, SignalReference& reference) {
  const pugi::xml_node node = reference.node;
  reference.signal_id = node.attribute("id").value();
  reference.s_m = in.number(node, "s");
  reference.t_m = in.number_or(node, "t", 0.0);
  reference.orientation = orientation_of(node.attribute("orientation").value());
  reference.lanes = read_lane_ranges(in, node);
  reference.line = in.xml.line_of(node);
}

}  // namespace

void read_signals(AttributeReader& in, pugi::xml_node signals, RoadRecord& road,
                  std::vector<ImportDiagnostic>& remarks) {
  for (const auto node : signals.children("signal")) {
    SignalRecord& signal = road.signals.emplace_back();
    signal.node = node;
    signal.is_broken = is_broken(in, "import.signal", remarks, [&] { read_signal(in, signal); });
  }
  for (const auto node : signals.children("signalReference")) {
    SignalReference& reference = road.signal_references.emplace_back();
    reference.node = node;
    reference.is_broken =
        is_broken(in, "import.signal", remarks, [&] { read_reference(in, reference); });
  }
}

}  // namespace roadbed::map::opendrive
