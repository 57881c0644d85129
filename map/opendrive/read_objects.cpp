#include "roadbed/map/opendrive/element_readers.h"

#include <string_view>

#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive {
namespace {

Outline read_outline(AttributeReader& in, pugi::xml_node node) {
  Outline outline;
  outline.closed = std::string_view(node.attribute("closed").value()) != "false";
  for (const auto corner : node.children()) {
    const std::string_view kind = corner.name();
    if (kind == "cornerRoad") {
      outline.corners.push_back(
          {true, in.number(corner, "s"), in.number(corner, "t"), in.number_or(corner, "dz", 0.0)});
    } else if (kind == "cornerLocal") {
      outline.corners.push_back(
          {false, in.number(corner, "u"), in.number(corner, "v"), in.number_or(corner, "z", 0.0)});
    }
  }
  return outline;
}

// <outline> of 1.4, or several in <outlines> from 1.5 on.
void read_outlines(AttributeReader& in, pugi::xml_node node, ObjectRecord& object) {
  for (const auto outline : node.children("outline")) {
    object.outlines.push_back(read_outline(in, outline));
  }
  for (const auto outline : node.child("outlines").children("outline")) {
    object.outlines.push_back(read_outline(in, outline));
  }
}

Repeat read_repeat(AttributeReader& in, pugi::xml_node node, const ObjectRecord& object) {
  const auto value = [&](const char* name, double otherwise) {
    return in.number_or(node, name, otherwise);
  };
  return {in.number(node, "s"),
          in.number(node, "length"),
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

void read_object(AttributeReader& in, ObjectRecord& object) {
  const pugi::xml_node node = object.node;
  const auto value = [&](const char* name) { return in.number_or(node, name, 0.0); };
  object.line = in.xml.line_of(node);
  object.id = node.attribute("id").value();
  object.name = node.attribute("name").value();
  object.type = node.attribute("type").value();
  object.subtype = node.attribute("subtype").value();
  object.s_m = in.number(node, "s");
  object.t_m = value("t");
  object.z_offset_m = value("zOffset");
  object.heading_rad = value("hdg");
  object.length_m = value("length");
  object.width_m = value("width");
  object.radius_m = value("radius");
  object.height_m = value("height");
  object.orientation = orientation_of(node.attribute("orientation").value());
  object.lanes = read_lane_ranges(in, node);
  read_outlines(in, node, object);
  for (const auto repeat : node.children("repeat")) {
    object.repeats.push_back(read_repeat(in, repeat, object));
  }
  keep_words(node, object);
}

Structure read_structure(AttributeReader& in, pugi::xml_node node) {
  return {node.name(),
          node.attribute("id").value(),
          node.attribute("name").value(),
          node.attribute("type").value(),
          in.number(node, "s"),
          in.number(node, "length"),
          read_lane_ranges(in, node)};
}

}  // namespace

void read_objects(AttributeReader& in, pugi::xml_node objects, RoadRecord& road,
                  std::vector<ImportDiagnostic>& remarks) {
  for (const auto node : objects.children("object")) {
    ObjectRecord& object = road.objects.emplace_back();
    object.node = node;
    object.is_broken = is_broken(in, "import.object", remarks, [&] { read_object(in, object); });
  }
  for (const auto node : objects.children("objectReference")) {
    ObjectReference reference{node.attribute("id").value(), 0.0, 0.0};
    const bool broken = is_broken(in, "import.object", remarks, [&] {
      reference.s_m = in.number(node, "s");
      reference.t_m = in.number_or(node, "t", 0.0);
    });
    if (!broken) road.object_references.push_back(std::move(reference));
  }
  for (const char* kind : {"bridge", "tunnel"}) {
    for (const auto node : objects.children(kind)) {
      Structure structure;
      const bool broken =
          is_broken(in, "import.object", remarks, [&] { structure = read_structure(in, node); });
      if (!broken) road.structures.push_back(std::move(structure));
    }
  }
}

}  // namespace roadbed::map::opendrive
