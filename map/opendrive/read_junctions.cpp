#include "roadbed/map/opendrive/element_readers.h"

#include <string_view>

#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive {
namespace {

JunctionKind junction_kind(std::string_view type) {
  if (type == "direct") return JunctionKind::direct;
  if (type == "virtual") return JunctionKind::virtual_;
  if (type == "crossing") return JunctionKind::crossing;
  return JunctionKind::common;
}

void read_connection(AttributeReader& in, JunctionConnection& connection) {
  const pugi::xml_node node = connection.node;
  connection.line = in.xml.line_of(node);
  connection.incoming_road = node.attribute("incomingRoad").value();
  connection.direct = !node.attribute("connectingRoad") && node.attribute("linkedRoad");
  connection.connecting_road =
      node.attribute(connection.direct ? "linkedRoad" : "connectingRoad").value();
  const std::string_view contact = node.attribute("contactPoint").value();
  connection.contact = contact == "end" ? ContactPoint::end : ContactPoint::start;
  connection.predecessor = read_road_link(in, node.child("predecessor"));
  connection.successor = read_road_link(in, node.child("successor"));
  for (const auto link : node.children("laneLink")) {
    const auto from = in.integer(link, "from"), to = in.integer(link, "to");
    if (from && to) connection.lane_links.emplace_back(*from, *to);
  }
}

}  // namespace

void read_junctions(AttributeReader& in, Document& document) {
  for (const auto node : in.xml.root().children("junction")) {
    JunctionRecord junction;
    junction.node = node;
    junction.id = in.text(node, "id");
    junction.name = node.attribute("name").value();
    junction.kind = junction_kind(node.attribute("type").value());
    for (const auto child : node.children("connection")) {
      JunctionConnection& connection = junction.connections.emplace_back();
      connection.node = child;
      connection.is_broken = is_broken(in, "import.junction", document.remarks,
                                       [&] { read_connection(in, connection); });
    }
    for (const auto priority : node.children("priority")) {
      junction.priorities.push_back(
          {priority.attribute("high").value(), priority.attribute("low").value()});
    }
    for (const auto controller : node.children("controller")) {
      junction.controllers.push_back(
          {controller.attribute("id").value(), controller.attribute("sequence").value()});
    }
    document.junctions.push_back(std::move(junction));
  }
}

void read_controllers(const XmlDocument& xml, Document& document) {
  for (const auto node : xml.root().children("controller")) {
    Controller controller;
    controller.source_id = node.attribute("id").value();
    controller.name = node.attribute("name").value();
    for (const auto control : node.children("control")) {
      controller.signals.emplace_back(control.attribute("signalId").value());
    }
    keep_attributes(node, {"sequence"}, controller.attributes);
    document.controllers.push_back(std::move(controller));
  }
}

}  // namespace roadbed::map::opendrive
