#pragma once

#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// Roads of virtual junctions join others in between (elementS): splits the lane sections there, so
/// that lanes end and begin where others join them. What is split is remarked; a station off the
/// road too.
void split_at_virtual_links(Document& document);

/// The lane sections of a road that meet at a station inside it: the one that ends there and the
/// one that begins there. None where no section begins at that station.
std::optional<std::pair<std::size_t, std::size_t>> sections_meeting_at(const RoadRecord& road,
                                                                       double s_m);

}  // namespace roadbed::map::opendrive
