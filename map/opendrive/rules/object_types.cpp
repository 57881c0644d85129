// What an object of each type may have: the tables of ASAM OpenDRIVE 1.8, section 13.14.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "roadbed/map/opendrive/rules/furniture.h"

namespace roadbed::map::opendrive::rules {
namespace {

enum Part : unsigned {
  radius = 1U << 0U,
  one_body = 1U << 1U,  ///< <repeat> with distance 0: one long body
  copies = 1U << 2U,    ///< <repeat> with a distance
  skeleton = 1U << 3U,
  markings = 1U << 4U,
  borders = 1U << 5U,
  material = 1U << 6U,
  surface = 1U << 7U,
  parking_space = 1U << 8U,
};

struct Named {
  Part part;
  const char* name;
};

constexpr std::array<Named, 9> kParts = {{
    {radius, "radius"},
    {one_body, "<repeat> with distance 0"},
    {copies, "<repeat> with a distance"},
    {skeleton, "<skeleton>"},
    {markings, "<markings>"},
    {borders, "<borders>"},
    {material, "<material>"},
    {surface, "<surface>"},
    {parking_space, "<parkingSpace>"},
}};

constexpr unsigned kPainted = markings | borders | material | surface | parking_space;

struct ObjectType {
  std::string_view name;
  unsigned forbidden;
  bool needs_box = false;  ///< a width and a length
};

constexpr std::array<ObjectType, 12> kTypes = {{
    {"barrier", radius | copies | skeleton | kPainted},
    {"building", one_body | skeleton | kPainted},
    {"crosswalk", radius | one_body | skeleton | borders | parking_space, true},
    {"gantry", radius | one_body | kPainted, true},
    {"obstacle", one_body | skeleton | kPainted},
    {"parkingSpace", radius | one_body | skeleton | borders, true},
    {"pole", one_body | kPainted},
    {"roadMark", radius | one_body | skeleton | borders | parking_space, true},
    {"roadSurface", one_body | skeleton | borders | parking_space | markings},
    {"trafficIsland", one_body | skeleton | surface | parking_space},
    {"tree", one_body | kPainted},
    {"vegetation", one_body | skeleton | kPainted},
}};

unsigned parts_of(const Source& source, pugi::xml_node object) {
  unsigned parts = 0;
  const auto add_if = [&](bool is_there, Part part) {
    if (is_there) parts |= part;
  };
  add_if(source.number(object, "radius") > 0.0, radius);
  for (const auto repeat : object.children("repeat")) {
    const double distance_m = source.number(repeat, "distance");
    add_if(distance_m == 0.0, one_body);
    add_if(distance_m > 0.0, copies);
  }
  for (const auto& [name, part] : {std::pair{"skeleton", skeleton},
                                   {"markings", markings},
                                   {"borders", borders},
                                   {"material", material},
                                   {"surface", surface},
                                   {"parkingSpace", parking_space}}) {
    add_if(static_cast<bool>(object.child(name)), part);
  }
  return parts;
}

/// "radius, <surface>".
std::string names_of(unsigned parts) {
  std::string names;
  for (const Named& named : kParts) {
    if ((parts & named.part) == 0) continue;
    if (!names.empty()) names += ", ";
    names += named.name;
  }
  return names;
}

void unfit_parts(const Source& source, const validation::ValidateOptions&,
                 validation::Report& report) {
  if (!source.is_since(8)) return;
  for_each_thing(source, "objects", "object", [&](const RoadSource& road, pugi::xml_node object) {
    const std::string_view name = object.attribute("type").value();
    const auto* type = std::ranges::find(kTypes, name, &ObjectType::name);
    if (type == kTypes.end()) return;
    if (const unsigned unfit = parts_of(source, object) & type->forbidden) {
      add_thing(report, source, road, object,
                fmt::format("is of type {} and has what such objects do not: {}; remove it or "
                            "correct the type",
                            name, names_of(unfit)));
    }
    const bool has_box = object.attribute("width") && object.attribute("length");
    if (!type->needs_box || has_box) return;
    add_thing(report, source, road, object,
              fmt::format("is of type {} and has no width and length, which such objects must "
                          "have; add them",
                          name));
  });
}

constexpr std::array<SourceRule, 1> kObjectTypeRules = {{
    {{"object.type-parts", "asam.net:xodr:1.8.0:road.object.attributes",
      validation::Severity::warning,
      "an object of a revision 1.8 file has what its type does not allow, or lacks its width and "
      "length"},
     unfit_parts},
}};

}  // namespace

std::span<const SourceRule> object_type_rules() { return kObjectTypeRules; }

}  // namespace roadbed::map::opendrive::rules
