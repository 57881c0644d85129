#pragma once

#include "roadbed/geometry/polygons/ring.h"

namespace roadbed::geometry::inline polygons {

/// Whether the ring falls into two chains that both run forwards along one direction and stay at
/// least 10 µm apart between their ends: then no two edges meet, whatever rounding does. Most
/// lanes' rings are so; of others it says nothing. O(N), fifty times faster than an exact test.
bool is_surely_simple(const Ring& ring);

/// Whether the edges of a ring cross each other at most eight times per point: the pieces of one
/// that folds more would take memory by the square of its length. Where edges are so long that
/// counting takes more than 20 million comparisons, they are not few either. O(N log N + K).
bool has_few_crossings(const Ring& ring);

}  // namespace roadbed::geometry::polygons
