#pragma once

#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// <objects> of a road: objects with outlines and repeats, references, bridges and tunnels. One
/// that cannot be read is left out and remarked.
void read_objects(const XmlDocument& xml, pugi::xml_node objects, RoadRecord& road,
                  std::vector<ImportRemark>& remarks);

}  // namespace roadbed::map::opendrive
