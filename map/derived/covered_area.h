#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"

namespace roadbed::map::inline derived {

/// A ring of the plane, and the group that it counts for besides all.
struct GroupedRing {
  const geometry::Ring* ring = nullptr;
  std::uint32_t group = kNoGroup;

  static constexpr std::uint32_t kNoGroup = 0xffffffff;
};

/// Area that at least one ring covers, and the sum over groups of what at least one ring of each
/// covers. A ring covers where it winds around an odd number of times.
struct CoveredArea {
  double all_m2 = 0.0, groups_m2 = 0.0;
};

/// Adds up the covered area without making its outline: the plane is halved until few edges are
/// left in a window, and there cut at the heights of vertices and crossings into slabs, in which
/// widths change linearly. Exact up to rounding: a crossing that rounding hides costs no more than
/// the sliver that it bounds. O(N log N + A) for N edges, A the edges that are met slab by slab,
/// which grows with how many rings lie upon each other.
/// @param threads  that may be used; the sum is the same for any number.
/// @return none where so many do that it would take over some hundred steps an edge.
std::optional<CoveredArea> covered_area(const std::vector<GroupedRing>& rings, int threads = 1);

}  // namespace roadbed::map::derived
