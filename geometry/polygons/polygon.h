#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/ring.h"

namespace roadbed::geometry::inline polygons {

/// The corners of a box, counter-clockwise from its least one.
Ring box_ring(const Eigen::Vector2d& least, const Eigen::Vector2d& most);

/// Area inside the ring [m²], positive if it runs counter-clockwise.
double signed_area_m2(const Ring& ring);

/// Area of the region, holes taken out [m²].
double area_m2(const Polygon& polygon);

/// Length of the closed ring [m].
double perimeter_m(const Ring& ring);

/// Whether the point is inside or on the ring. O(N).
bool contains(const Ring& ring, const Eigen::Vector2d& point);
bool contains(const Polygon& polygon, const Eigen::Vector2d& point);

/// How a ray from a point along the x axis meets an edge.
enum class RayCrossing { misses, crosses, on_edge };

/// Exact: over all edges of a region's rings, a point is inside where the number of edges that its
/// ray crosses is odd; `on_edge` if the edge passes the point. An edge's upper end is not part of
/// it, so that a ray through a shared end crosses one of two edges.
RayCrossing crossing(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                     const Eigen::Vector2d& point);

/// Whether no two edges meet except neighbours at their shared point. Exact (CGAL).
bool is_simple(const Ring& ring);

/// What a ring winds around (non-zero rule) as simple polygons: where it folds over itself it falls
/// into pieces; none if its edges cross so often that has_few_crossings() denies. Exact (CGAL).
std::vector<Polygon> make_simple(const Ring& ring);

/// Union of regions. Points within `weld_m` of each other are taken as one first, since roads of
/// real files do not meet exactly; 0 welds nothing. Exact (CGAL). O((N + K) log N) for K crossings.
std::vector<Polygon> unite(std::span<const Polygon> polygons, double weld_m);

/// A union, and what the welding before it moved.
struct United {
  std::vector<Polygon> polygons;
  std::size_t moved_points = 0;
  double most_moved_m = 0.0;
};

/// `unite` that says what its welding did.
United unite_and_report(std::span<const Polygon> polygons, double weld_m);

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
