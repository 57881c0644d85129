#pragma once

#include <cstddef>
#include <pugixml.hpp>
#include <vector>

#include "roadbed/map/edit/merging/merge.h"
#include "roadbed/map/files/xml.h"

namespace roadbed::map::inline edit::inline merging {

/// A lanelet of CommonRoad and which file it is from.
struct SourcedLanelet {
  pugi::xml_node node;
  std::size_t source = 0;
};

/// Links lanelets of different files that lead nowhere yet, where both borders of one end at most
/// the tolerance from where those of the other begin, and adds a seam for each such place.
void link_lanelet_ends(const XmlDocument& xml, const std::vector<SourcedLanelet>& lanelets,
                       double tolerance_m, std::vector<Seam>& seams);

}  // namespace roadbed::map::edit::merging
