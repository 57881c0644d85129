#pragma once

#include <cstddef>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "roadbed/map/edit/merging/merge.h"

namespace roadbed::map::inline edit::inline merging {

/// Links ends of roads of different files that lead nowhere yet, where just two of them meet: their
/// reference lines end at most the tolerance apart in space, in one direction to within 0.1 rad,
/// and lanes that face each other meet: they are of one type, and the ends of their borders at most
/// the tolerance apart in space. Other lanes stay without a link. Adds a seam for each place where
/// ends meet in the plane.
/// @param root     `<OpenDRIVE>`.
/// @param sources  of each road by its id, which file it is from.
void link_coinciding_ends(pugi::xml_node root, const std::map<std::string, std::size_t>& sources,
                          double tolerance_m, std::vector<Seam>& seams);

}  // namespace roadbed::map::edit::merging
