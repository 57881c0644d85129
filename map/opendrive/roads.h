#pragma once

#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// All <road> elements into `document.roads`; roads without a geometry are left out and remarked.
/// @throws InputError if a number cannot be that of a road, an id occurs twice, or there is none.
void read_roads(const XmlDocument& xml, Document& document);

/// <predecessor>/<successor> of a road or of a virtual connection; none if there is no such node.
std::optional<RoadLink> read_road_link(const XmlDocument& xml, pugi::xml_node node);

}  // namespace roadbed::map::opendrive
