#pragma once

#include <Eigen/Core>
#include <optional>
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
/// Where a road ends, the line ends about half its width before. A circle has none: its middle is a
/// place. Branches are in order of their first point, by x, then y. O(N log N).
/// @param polygon  valid: simple rings that do not cross, the outer one counter-clockwise, holes
///     clockwise.
std::vector<MedialBranch> medial_axis(const Polygon& polygon,
                                      const MedialAxisOptions& options = {});

/// Of the Voronoi diagram of a polygon's edges, the part inside: its places are equally far from
/// two edges or corners, and no nearer to any other.
struct VoronoiGraph {
  struct Node {
    Eigen::Vector2d at{0, 0};
    double clearance_m = 0.0;  ///< to the nearest edge
  };
  /// Between two nodes, straight or a part of a parabola.
  struct Edge {
    std::size_t from = 0, to = 0;
    /// Of a parabola: its focus, a corner, and two points of its directrix, an edge.
    struct Parabola {
      Eigen::Vector2d focus, line_a, line_b;
    };
    std::optional<Parabola> parabola;
  };
  std::vector<Node> nodes;
  std::vector<Edge> edges;
};

/// Edges that end in a corner of the polygon are left out. Corners lie on a grid, 2⁻³⁰ of half the
/// polygon's extent (1 µm for 2 km), or coarser where its edges would cross on it; on the grid all
/// is exact (Boost.Polygon), then rounded to doubles. O(N log N).
/// @param polygon  valid: simple rings that do not cross, the outer one counter-clockwise.
/// @throws TooMuchWork  where its edges cross on every grid.
VoronoiGraph interior_voronoi(const Polygon& polygon);

}  // namespace roadbed::geometry::polygons
