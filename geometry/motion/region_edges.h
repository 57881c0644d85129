#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/polygons/ring.h"

namespace roadbed::geometry::inline motion {

/// A region of the plane, asked by its edges whether shapes are inside it, and how far they are
/// from leaving it. Seams between its polygons are not its edges: unite them first.
///
///     ┌───────────────────┐        no edge meets the shape, and one of its points is inside:
///     │   ┌────┐   ┌──┐   │        then all of it is, whatever its size
///     │   └────┘◀─▶└──┘   │
///     └──────── distance ─┘
///
/// Distances are rounded by less than 10⁻⁹ m where coordinates stay below 10⁷ m; `contains` is
/// exact.
class RegionEdges {
 public:
  RegionEdges() = default;

  /// @param polygons  with disjoint insides, outer rings counter-clockwise and holes clockwise, as
  ///                  `unite` makes them.
  explicit RegionEdges(const std::vector<Polygon>& polygons);

  /// Whether the point is in the region or on its edge. O(log N) on average.
  bool contains(const Eigen::Vector2d& point) const;

  /// The edge that is nearest to a shape.
  struct Nearest {
    double distance_m = 0.0;  ///< 0: the edge meets the shape
    bool is_inside = false;   ///< the shape is in the region; meaningless at distance 0
    Eigen::Vector2d on_edge{0, 0}, on_shape{0, 0};  ///< nearest points, on the edge at distance 0
  };

  /// None if no edge is nearer than `within_m`. O(log N) on average for small shapes.
  std::optional<Nearest> nearest(const Rectangle& shape, double within_m) const;

  /// The same of a point.
  std::optional<Nearest> nearest(const Eigen::Vector2d& point, double within_m) const {
    return nearest(Rectangle{.centre = point}, within_m);
  }

  bool is_empty() const { return edges_.empty(); }
  std::size_t size() const { return edges_.size(); }  ///< edges
  const Box& extent() const { return extent_; }

 private:
  struct Edge {
    Eigen::Vector2d from, to;
    std::uint32_t previous = 0, next = 0;  // in the ring
  };
  void add(const Ring& ring);
  void mark_shared_points();
  bool is_left_of(std::size_t edge, const Eigen::Vector2d& point,
                  const Eigen::Vector2d& on_edge) const;

  template <typename Bound, typename Visit>
  void descend(double most_m2, const Bound& bound_m2, const Visit& visit) const;

  std::vector<Edge> edges_;
  std::vector<char> is_shared_;       // whether an edge starts where another ring passes as well
  std::vector<std::uint32_t> order_;  // edges along a Hilbert curve: the leaves
  std::vector<std::vector<Box>> levels_;  // boxes around them, the root last
  Box extent_;
};

}  // namespace roadbed::geometry::motion
