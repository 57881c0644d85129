#pragma once

#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// <signals> of a road: signals and references to signals of other roads. One that cannot be read
/// is left out and remarked: it must not make a city unusable.
void read_signals(const XmlDocument& xml, pugi::xml_node signals, RoadRecord& road,
                  std::vector<ImportRemark>& remarks);

}  // namespace roadbed::map::opendrive
