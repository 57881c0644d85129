#pragma once

#include "roadbed/geometry/polygons/polygon.h"

namespace roadbed::geometry::inline polygons {

/// Whether the edges of a ring cross each other at most eight times per point: the pieces of one
/// that folds more would take memory by the square of its length. Where edges are so long that
/// counting takes more than 20 million comparisons, they are not few either. O(N log N + K).
bool has_few_crossings(const Ring& ring);

}  // namespace roadbed::geometry::polygons
