#pragma once

#include "roadbed/map/formats/open_drive_document.h"

namespace roadbed::map::open_drive {

/// <planView> into `road.plan_pieces`, in order of s. Pieces of no length are left out; those, and
/// lengths that do not fit, are remarked.
/// @throws InputError if a value lies beyond that of any road.
void read_plan_view(const XmlDocument& xml, pugi::xml_node node, RoadRecord& road,
                    Document& document);

/// Longest road that is taken for one [m].
inline constexpr double kLongestRoadM = 1e6;

}  // namespace roadbed::map::open_drive
