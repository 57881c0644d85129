#pragma once

#include <cstddef>
#include <deque>
#include <set>
#include <string>
#include <vector>

#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/edit/merging/merge.h"
#include "roadbed/map/edit/new_ids.h"

namespace roadbed::map::inline edit::inline merging {

/// Files that have parts of one lanelet, which is in the first of them now.
struct JoinedLanelet {
  std::string id;
  std::set<std::size_t> files;
};

/// Puts the parts of lanelets that a clip left (map/edit/lanelet_parts.h) to those that they go on
/// from, in the first file that has one; the others are taken off theirs. Parts are of one lanelet
/// if they say the same and are at one place where both are, to within 1 mm. Of several that stay
/// apart the first keeps the id of the whole.
/// @param files  links recalled.
/// @param fresh  knows all ids.
/// @param result  gets the seams, and what has another id now.
/// @returns what has had parts in several files.
std::vector<JoinedLanelet> join_lanelets(const std::deque<commonroad::Document>& files,
                                         FreshIds& fresh, Merged& result);

}  // namespace roadbed::map::edit::merging
