#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"

// The Voronoi diagram of a polygon's edges. segment_voronoi.cpp is the only file that sees CGAL's
// segment Delaunay graph.

namespace roadbed::geometry::inline polygons {

/// The part of the diagram inside the polygon: its places are equally far from two edges or
/// corners, and no nearer to any other.
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

/// Edges that end in a corner of the polygon are left out. Predicates are exact, places are those
/// of doubles. O(N log N).
/// @param polygon  valid: simple rings that do not cross, the outer one counter-clockwise.
VoronoiGraph interior_voronoi(const Polygon& polygon);

}  // namespace roadbed::geometry::polygons
