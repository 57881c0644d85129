#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "roadbed/map/edit/merging/merge.h"
#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::inline edit::inline merging {

/// What an element of a file is called in the merged map.
using CalledInMerged = std::function<std::int64_t(std::size_t file, std::int64_t id)>;

/// Nodes that become one where a lanelet of one file ends and one of another begins: both ends of
/// its borders are at most the tolerance apart, and are not one already. They are apart in space
/// where both nodes have a height, else in the plane. Adds a seam for each pair.
/// @param called          names of nodes.
/// @param lanelet_called  names of whole lanelets: parts of one are put together anyhow.
/// @returns for each node that goes, the one that stays, by these names.
std::map<std::int64_t, std::int64_t> nodes_to_join(const std::vector<lanelet2::Document>& files,
                                                   const CalledInMerged& called,
                                                   const CalledInMerged& lanelet_called,
                                                   double tolerance_m, std::vector<Seam>& seams);

}  // namespace roadbed::map::edit::merging
