#pragma once

#include <functional>
#include <pugixml.hpp>
#include <string>
#include <utility>
#include <vector>

namespace roadbed::map::inline edit {

/// Where an element of OpenDRIVE names a road, with the attributes that are stations of that road.
struct NamedRoad {
  pugi::xml_node node;
  const char* attribute = nullptr;  ///< of the node: the road's id
  std::vector<std::pair<pugi::xml_node, const char*>> stations = {};  ///< those that are written

  std::string road() const { return node.attribute(attribute).value(); }
};

/// The roads that one element names itself: links, connections, priorities, sections, boundaries
/// and crossing paths of junctions, platforms of stations, tracks of switches, physical positions
/// of signals (ASAM OpenDRIVE 1.8). Links to a junction name none.
std::vector<NamedRoad> named_roads(pugi::xml_node element);

/// All that an element and those in it name, user data left out.
void for_each_named_road(pugi::xml_node element, const std::function<void(const NamedRoad&)>& f);

}  // namespace roadbed::map::edit
