#pragma once

#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// <planView> into `road.plan_pieces`, in order of s. Pieces of no length are left out; those, and
/// lengths that do not fit, are remarked.
/// @throws InputError if a value lies beyond that of any road.
void read_plan_view(const XmlDocument& xml, pugi::xml_node node, RoadRecord& road,
                    Document& document);

/// Longest road that is taken for one [m].
inline constexpr double kLongestRoadM = 1e6;

}  // namespace roadbed::map::opendrive
