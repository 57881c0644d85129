#pragma once

#include <cstddef>
#include <pugixml.hpp>

namespace roadbed::map::inline edit {

// What elements of an OpenDRIVE file say of each other: links of roads, connections, priorities and
// controllers of junctions, signals of controllers, references to signals and objects, and all that
// names places of roads (named_roads.h).

/// What `settle_references` took off, and keeps in clip memories.
struct SettledReferences {
  std::size_t links = 0, connections = 0, junctions = 0, controls = 0, references = 0;
};

/// Makes references fit the roads that are there. They are given as in the whole map; what leads to
/// a road, an end of a road, a junction or a signal that is not there is taken off, and what it was
/// is kept in a clip memory: that of the road, or that of the root for junctions and controllers.
/// What leads to a road that is there in parts leads to the right one of them.
SettledReferences settle_references(pugi::xml_node root);

}  // namespace roadbed::map::edit
