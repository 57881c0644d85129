#pragma once

#include "roadbed/map/formats/open_drive_document.h"

namespace roadbed::map::open_drive {

/// <objects> of a road: objects with outlines and repeats, references, bridges and tunnels. One
/// that cannot be read is left out and remarked.
void read_objects(const XmlDocument& xml, pugi::xml_node objects, RoadRecord& road,
                  std::vector<ImportRemark>& remarks);

}  // namespace roadbed::map::open_drive
