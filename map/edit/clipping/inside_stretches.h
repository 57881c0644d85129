#pragma once

#include <vector>

#include "roadbed/map/edit/clipping/region.h"
#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::inline edit::inline clipping {

/// A part of a road between two stations.
struct StationSpan {
  double from_m = 0.0, to_m = 0.0;
};

/// Where a road's cross-section, from its outermost left border to its outermost right one, has a
/// point in the region: in order, the ends exact to 1 µm, outwards. What is there for less than
/// 0.1 m along the road may be missed, unless it reaches over an end of a lane section.
/// @param road  of a mended document.
/// @param origin_in_source  the document's.
std::vector<StationSpan> stretches_inside(const opendrive::RoadRecord& road,
                                          const Eigen::Vector2d& origin_in_source,
                                          const Region& region);

/// A box around the road: where a region does not meet it, there are no such stretches.
geometry::Box box_around(const opendrive::RoadRecord& road,
                         const Eigen::Vector2d& origin_in_source);

}  // namespace roadbed::map::edit::clipping
