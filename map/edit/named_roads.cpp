#include "roadbed/map/edit/named_roads.h"

#include <array>
#include <string_view>

namespace roadbed::map::inline edit {
namespace {

/// Station attributes are those of a child where one is named.
struct Naming {
  std::string_view element;
  const char *attribute, *first = nullptr, *last = nullptr, *child = nullptr;
};

constexpr std::array<Naming, 16> kNamings = {{
    {"predecessor", "elementId", "elementS"},
    {"successor", "elementId", "elementS"},
    {"positionRoad", "roadId", "s"},
    {"mainTrack", "id", "s"},
    {"sideTrack", "id", "s"},
    {"junction", "mainRoad", "sStart", "sEnd"},
    {"connection", "incomingRoad"},
    {"connection", "connectingRoad"},
    {"connection", "linkedRoad"},
    {"priority", "high"},
    {"priority", "low"},
    {"roadSection", "roadId", "sStart", "sEnd"},
    {"segment", "roadId", "sStart", "sEnd"},  // of a junction's boundary, or a platform
    {"crossPath", "crossingRoad"},
    {"crossPath", "roadAtStart", "s", nullptr, "startLaneLink"},
    {"crossPath", "roadAtEnd", "s", nullptr, "endLaneLink"},
}};

}  // namespace

std::vector<NamedRoad> named_roads(pugi::xml_node element) {
  std::vector<NamedRoad> found;
  if (std::string_view(element.attribute("elementType").value()) == "junction") return found;
  for (const Naming& naming : kNamings) {
    if (naming.element != element.name() || !element.attribute(naming.attribute)) continue;
    NamedRoad& named = found.emplace_back(NamedRoad{element, naming.attribute});
    const auto at = naming.child == nullptr ? element : element.child(naming.child);
    for (const char* station : {naming.first, naming.last}) {
      if (station != nullptr && at.attribute(station)) named.stations.emplace_back(at, station);
    }
  }
  return found;
}

void for_each_named_road(pugi::xml_node element, const std::function<void(const NamedRoad&)>& f) {
  std::vector<pugi::xml_node> open{element};  // not by recursion: files may be deep
  while (!open.empty()) {
    const pugi::xml_node node = open.back();
    open.pop_back();
    for (const NamedRoad& named : named_roads(node)) f(named);
    for (const auto child : node.children()) {
      const std::string_view name = child.name();
      if (name != "userData" && name != "planView" && name != "lanes") open.push_back(child);
    }
  }
}

}  // namespace roadbed::map::edit
