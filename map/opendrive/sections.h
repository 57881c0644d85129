#pragma once

#include <vector>

#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// All lane sections of a road, in order of s; what is mended is added to the document's remarks.
/// @throws InputError if an id occurs twice, a number is none, or there are more lanes than memory
///         is granted for.
std::vector<LaneSection> read_sections(const XmlDocument& xml, pugi::xml_node lanes,
                                       const RoadRecord& road, Document& document);

/// Fills in which section follows which on each side. O(number of sections).
void connect_sections(std::vector<LaneSection>& sections);

}  // namespace roadbed::map::opendrive
