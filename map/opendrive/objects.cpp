#include "roadbed/map/opendrive/objects.h"

#include <string_view>

#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive {
namespace {

Outline read_outline(const XmlDocument& xml, pugi::xml_node node) {
  Outline outline;
  outline.closed = std::string_view(node.attribute("closed").value()) != "false";
  for (const auto corner : node.children()) {
    const std::string_view kind = corner.name();
    if (kind == "cornerRoad") {
      outline.corners.push_back({true, xml.number(corner, "s"), xml.number(corner, "t"),
                                 xml.number_or(corner, "dz", 0.0)});
    } else if (kind == "cornerLocal") {
      outline.corners.push_back({false, xml.number(corner, "u"), xml.number(corner, "v"),
                                 xml.number_or(corner, "z", 0.0)});
    }
  }
  return outline;
}

// <outline> of 1.4, or several in <outlines> from 1.5 on.
void read_outlines(const XmlDocument& xml, pugi::xml_node node, ObjectRecord& object) {
  for (const auto outline : node.children("outline")) {
    object.outlines.push_back(read_outline(xml, outline));
  }
  for (const auto outline : node.child("outlines").children("outline")) {
    object.outlines.push_back(read_outline(xml, outline));
  }
}

Repeat read_repeat(const XmlDocument& xml, pugi::xml_node node, const ObjectRecord& object) {
  const auto value = [&](const char* name, double otherwise) {
    return xml.number_or(node, name, otherwise);
  };
  return {xml.number(node, "s"),
          xml.number(node, "length"),
          value("distance", 0.0),
          value("tStart", object.t_m),
          value("tEnd", value("tStart", object.t_m)),
          value("zOffsetStart", object.z_offset_m),
          value("zOffsetEnd", value("zOffsetStart", object.z_offset_m)),
          value("widthStart", object.width_m),
          value("widthEnd", value("widthStart", object.width_m)),
          value("heightStart", object.height_m)};
}

void keep_words(pugi::xml_node node, ObjectRecord& object) {
  keep_attributes(node,
                  {"subtype", "orientation", "validLength", "dynamic", "hdg", "pitch", "roll",
                   "length", "width", "radius", "perpToRoad", "temporary"},
                  object.attributes);
  for (const char* name : {"parkingSpace", "material", "validity"}) {
    for (const auto child : node.children(name)) {
      object.attributes.emplace_back(name, described(child));
    }
  }
}

ObjectRecord read_object(const XmlDocument& xml, pugi::xml_node node) {
  ObjectRecord object;
  const auto value = [&](const char* name) { return xml.number_or(node, name, 0.0); };
  object.line = xml.line_of(node);
  object.id = node.attribute("id").value();
  object.name = node.attribute("name").value();
  object.type = node.attribute("type").value();
  object.subtype = node.attribute("subtype").value();
  object.s_m = xml.number(node, "s");
  object.t_m = value("t");
  object.z_offset_m = value("zOffset");
  object.heading_rad = value("hdg");
  object.length_m = value("length");
  object.width_m = value("width");
  object.radius_m = value("radius");
  object.height_m = value("height");
  object.orientation = orientation_of(node.attribute("orientation").value());
  object.lanes = read_lane_ranges(xml, node);
  read_outlines(xml, node, object);
  for (const auto repeat : node.children("repeat")) {
    object.repeats.push_back(read_repeat(xml, repeat, object));
  }
  keep_words(node, object);
  return object;
}

Structure read_structure(const XmlDocument& xml, pugi::xml_node node) {
  return {node.name(),
          node.attribute("id").value(),
          node.attribute("name").value(),
          node.attribute("type").value(),
          xml.number(node, "s"),
          xml.number(node, "length"),
          read_lane_ranges(xml, node)};
}

}  // namespace

void read_objects(const XmlDocument& xml, pugi::xml_node objects, RoadRecord& road,
                  std::vector<ImportRemark>& remarks) {
  for (const auto node : objects.children("object")) {
    read_or_remark("import.object", remarks,
                   [&] { road.objects.push_back(read_object(xml, node)); });
  }
  for (const auto node : objects.children("objectReference")) {
    read_or_remark("import.object", remarks, [&] {
      road.object_references.push_back(
          {node.attribute("id").value(), xml.number(node, "s"), xml.number_or(node, "t", 0.0)});
    });
  }
  for (const char* kind : {"bridge", "tunnel"}) {
    for (const auto node : objects.children(kind)) {
      read_or_remark("import.object", remarks,
                     [&] { road.structures.push_back(read_structure(xml, node)); });
    }
  }
}

}  // namespace roadbed::map::opendrive
