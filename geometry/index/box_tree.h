#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace roadbed::geometry::inline index {

/// An upright rectangle of the plane [m].
using Box = Eigen::AlignedBox2d;

/// The least box around points; empty for none.
Box box_around(std::span<const Eigen::Vector2d> points);

/// A packed tree: the leaves, then level by level the boxes around each `width` of the level below,
/// up to one root. Not of nothing.
std::vector<std::vector<Box>> packed_levels(std::vector<Box> leaves, std::size_t width);

/// Finds those of a fixed set of boxes that meet a box. A packed tree: boxes in the order of their
/// centres along a Hilbert curve, eight to a node. Immutable. O(N log N) to make.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(const std::vector<Box>& boxes);

  /// Calls `found` with the index of every box that meets `box` (touching counts); the order is
  /// fixed but has no meaning. O(log N + found) on average.
  void visit(const Box& box, const std::function<void(std::size_t index)>& found) const;

  /// The least of `distance_m(index)` over all boxes, which must be at least the distance to the
  /// box; starts from `most_m`. Returns the index, or the number of boxes if none is nearer.
  /// Of equally near ones any. O(log N) on average.
  std::size_t nearest(const Eigen::Vector2d& point, double most_m,
                      const std::function<double(std::size_t index)>& distance_m) const;

  std::size_t size() const { return order_.size(); }

 private:
  std::vector<std::uint32_t> order_;      ///< index of each leaf box
  std::vector<std::vector<Box>> levels_;  ///< leaves first, the root last
};

}  // namespace roadbed::geometry::index
