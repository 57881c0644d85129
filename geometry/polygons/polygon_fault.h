#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "roadbed/geometry/polygons/polygon.h"

namespace roadbed::geometry::inline polygons {

/// What makes a polygon unusable, and in which of its rings.
struct PolygonFault {
  std::size_t ring = 0;  ///< 0: the outer one, i: hole i − 1
  std::string what;      ///< "its edges cross", …
};

/// Whether rings enclose a region: each has an area and does not cross itself, every hole lies
/// inside the outer ring, and no two holes overlap. They may touch at points. Either sense of
/// rotation is allowed. Exact (CGAL). O(N log N) for a faultless polygon.
std::optional<PolygonFault> find_fault(const Polygon& polygon);

}  // namespace roadbed::geometry::polygons
