#include "roadbed/geometry/index/point_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace roadbed::geometry::inline index {
namespace {

// The first of each place, in their order: of those that are equally near a tree looks at all.
std::vector<std::size_t> distinct(const std::vector<Eigen::Vector2d>& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return std::tuple(points[a].x(), points[a].y(), a) <
           std::tuple(points[b].x(), points[b].y(), b);
  });
  const auto is_same = [&](std::size_t a, std::size_t b) { return points[a] == points[b]; };
  order.erase(std::unique(order.begin(), order.end(), is_same), order.end());
  std::ranges::sort(order);
  return order;
}

}  // namespace

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

  explicit Tree(const std::vector<Eigen::Vector2d>& points)
      : indices(distinct(points)),
        set(set_of(points, indices)),
        tree(2, set, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {}

  static PointSet set_of(const std::vector<Eigen::Vector2d>& points,
                         const std::vector<std::size_t>& indices) {
    PointSet set;
    for (const std::size_t i : indices) set.points.push_back(points[i]);
    return set;
  }

  std::vector<std::size_t> indices;  // in the order of the constructor
  PointSet set;
  KdTree tree;
};

PointIndex::PointIndex(const std::vector<Eigen::Vector2d>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      throw std::invalid_argument(fmt::format("PointIndex: point {} is not finite", i));
    }
  }
  tree_ = std::make_unique<const Tree>(points);
}

PointIndex::~PointIndex() = default;
PointIndex::PointIndex(PointIndex&&) noexcept = default;
PointIndex& PointIndex::operator=(PointIndex&&) noexcept = default;

std::optional<PointIndex::Nearest> PointIndex::nearest(const Eigen::Vector2d& point) const {
  std::size_t index = 0;
  double squared = 0.0;
  if (tree_->tree.knnSearch(point.data(), 1, &index, &squared) == 0) return std::nullopt;
  return Nearest{tree_->indices[index], std::sqrt(squared)};
}

}  // namespace roadbed::geometry::index
