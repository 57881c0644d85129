#pragma once

#include <vector>

#include "roadbed/map/formats/open_drive_document.h"

namespace roadbed::map::open_drive {

/// All lane sections of a road, in order of s; what is mended is added to the remarks.
std::vector<LaneSection> read_sections(const XmlDocument& xml, pugi::xml_node lanes,
                                       const RoadRecord& road, std::vector<ImportRemark>& remarks);

}  // namespace roadbed::map::open_drive
