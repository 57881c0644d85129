#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace roadbed::geometry::inline index {

/// Nearest-point queries over a fixed set of points of the plane (a KD-tree). Immutable.
class PointIndex {
 public:
  /// @throws std::invalid_argument if a point is not finite.
  explicit PointIndex(const std::vector<Eigen::Vector2d>& points);
  ~PointIndex();
  PointIndex(PointIndex&&) noexcept;
  PointIndex& operator=(PointIndex&&) noexcept;

  struct Nearest {
    std::size_t index;  ///< as constructed; of equally near points any, of equal ones the first
    double distance_m;
  };

  /// None if there are no points. O(log N) on average.
  std::optional<Nearest> nearest(const Eigen::Vector2d& point) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace roadbed::geometry::index
