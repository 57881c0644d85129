#pragma once

#include <vector>

#include "roadbed/geometry/polygons/ring.h"

namespace roadbed::geometry::inline polygons {

/// Whether edges of rings that lie on each other cross or touch those of others at most 50,000
/// times and 16 times per edge: an exact union keeps each of these places, at 1.4 kB. O(N log N).
bool have_few_crossings(const std::vector<Ring>& rings);

}  // namespace roadbed::geometry::polygons
