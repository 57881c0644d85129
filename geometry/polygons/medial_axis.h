#pragma once

#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/primitives/polyline.h"

namespace roadbed::geometry::inline polygons {

/// A stretch of the line in the middle of an area, between two forks or ends.
///
///     ┌──────────────────────────
///     │       width
///     │   ●──────────●─────────      the line is equally far from both sides
///     │               ╲
///     └────────────────╲──
struct MedialBranch {
  Polyline line;
  std::vector<double> width_m;  ///< of the area across the line, one per point
  bool closed = false;          ///< it ends where it begins: a ring without a fork
};

struct MedialAxisOptions {
  double max_error_m = 0.01;  ///< chord error of the parabolas between an edge and a corner
};

/// The places inside a polygon that are equally far from two sides of it (Blum 1967), without the
/// branches that only lead into a corner: those shorter than the area is wide where they begin.
/// Where a road ends, the line ends about half its width before. Branches are in order of their
/// first point, by x, then y. O(N log N).
/// @param polygon  valid: simple rings that do not cross, the outer one counter-clockwise, holes
///     clockwise.
std::vector<MedialBranch> medial_axis(const Polygon& polygon,
                                      const MedialAxisOptions& options = {});

}  // namespace roadbed::geometry::polygons
