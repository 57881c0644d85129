#include "roadbed/geometry/index/point_index.h"

#include <fmt/format.h>

#include <cmath>
#include <nanoflann.hpp>
#include <stdexcept>
#include <utility>

namespace roadbed::geometry::inline index {
struct PointIndex::Tree {
  // What nanoflann asks of a set of points.
  struct PointSet {
    std::vector<Eigen::Vector2d> points;

    std::size_t kdtree_get_point_count() const { return points.size(); }
    double kdtree_get_pt(std::size_t index, std::size_t axis) const {
      return points[index][static_cast<Eigen::Index>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;  // let it find the bounds itself
    }
  };

  using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointSet>,
                                                     PointSet, 2, std::size_t>;

  explicit Tree(std::vector<Eigen::Vector2d> points)
      : set{std::move(points)}, tree(2, set, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {}
  PointSet set;
  KdTree tree;
};

PointIndex::PointIndex(std::vector<Eigen::Vector2d> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      throw std::invalid_argument(fmt::format("PointIndex: point {} is not finite", i));
    }
  }
  tree_ = std::make_unique<const Tree>(std::move(points));
}

PointIndex::~PointIndex() = default;
PointIndex::PointIndex(PointIndex&&) noexcept = default;
PointIndex& PointIndex::operator=(PointIndex&&) noexcept = default;

std::optional<PointIndex::Nearest> PointIndex::nearest(const Eigen::Vector2d& point) const {
  std::size_t index = 0;
  double squared = 0.0;
  if (tree_->tree.knnSearch(point.data(), 1, &index, &squared) == 0) return std::nullopt;
  return Nearest{index, std::sqrt(squared)};
}

}  // namespace roadbed::geometry::index
