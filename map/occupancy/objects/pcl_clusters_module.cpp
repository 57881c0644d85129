// Of the module that links PCL, as clouds/pcl_module.cpp is. Never to be compiled with
// -march=native.
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "roadbed/map/occupancy/objects/pcl_objects.h"

namespace {

using Point = pcl::PointXYZ;
using PointVector = std::vector<Point, Eigen::aligned_allocator<Point>>;

float squared_m2(const Point& a, const Point& b) {
  return (a.getVector3fMap() - b.getVector3fMap()).squaredNorm();
}

/// The distinct points of a cube so small that all are within the tolerance of one another.
struct Cube {
  std::array<std::int64_t, 3> place;
  std::size_t from, to;  // of all distinct points
  Eigen::AlignedBox3f box;
  pcl::KdTreeFLANN<Point>::Ptr tree;  // made when it is first asked
};

/// Euclidean clusters as PCL's EuclideanClusterExtraction finds them, which asks for the neighbours
/// of each point: quadratic where points crowd. Here cubes are joined, one pair of near points
/// each.
class Clustering {
 public:
  Clustering(std::span<const Point> points, double tolerance)
      : points_(points), tolerance_(tolerance), side_(tolerance / std::sqrt(3.0)) {
    fill_cubes();
    parents_.resize(cubes_.size());
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
    for (std::size_t i = 0; i < cubes_.size(); ++i) join_with_later(i);
  }

  /// A number of its cluster for each point, the same for all of one.
  std::vector<std::size_t> clusters() {
    std::vector<std::size_t> clusters(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) clusters[i] = root(cube_of_point_[i]);
    return clusters;
  }

 private:
  static constexpr std::int64_t kReach = 2;       // cubes between which points may be near
  static constexpr std::size_t kFewPairs = 4096;  // that are compared one by one

  std::array<std::int64_t, 3> place_of(const Point& point) const {
    const auto index = [&](float value) {
      return static_cast<std::int64_t>(std::floor(static_cast<double>(value) / side_));
    };
    return {index(point.x), index(point.y), index(point.z)};
  }

  void fill_cubes() {
    struct Placed {
      std::array<std::int64_t, 3> place;
      std::size_t point;
    };
    std::vector<Placed> placed;
    placed.reserve(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) placed.push_back({place_of(points_[i]), i});
    std::ranges::sort(placed, [&](const Placed& a, const Placed& b) {
      const Point &p = points_[a.point], &q = points_[b.point];
      return std::tie(a.place, p.x, p.y, p.z) < std::tie(b.place, q.x, q.y, q.z);
    });
    distinct_.reserve(points_.size());
    cube_of_point_.resize(points_.size());
    for (const Placed& next : placed) {
      if (cubes_.empty() || cubes_.back().place != next.place) {
        cubes_.push_back({next.place, distinct_.size(), distinct_.size(), {}, {}});
      }
      Cube& cube = cubes_.back();
      const Point& point = points_[next.point];
      if (cube.from == cube.to || squared_m2(distinct_.back(), point) > 0.0f) {
        distinct_.push_back(point);
        ++cube.to;
        cube.box.extend(point.getVector3fMap());
      }
      cube_of_point_[next.point] = cubes_.size() - 1;
    }
  }

  // Cubes stand in order of x, y and z: those of one column are found at once.
  void join_with_later(std::size_t i) {
    const auto [x, y, z] = cubes_[i].place;
    for (std::int64_t column = x; column <= x + kReach; ++column) {
      for (std::int64_t row = column == x ? y : y - kReach; row <= y + kReach; ++row) {
        const std::array<std::int64_t, 3> lowest{column, row, z - kReach};
        auto other = std::ranges::lower_bound(cubes_, lowest, {}, &Cube::place);
        for (; other != cubes_.end() && other->place[0] == column && other->place[1] == row &&
               other->place[2] <= z + kReach;
             ++other) {
          const auto k = static_cast<std::size_t>(other - cubes_.begin());
          if (k > i && root(i) != root(k) && are_near(cubes_[i], cubes_[k])) join(i, k);
        }
      }
    }
  }

  bool are_near(Cube& a, Cube& b) const {
    Cube& few = a.to - a.from < b.to - b.from ? a : b;
    Cube& many = &few == &a ? b : a;
    const std::span<const Point> some = points_of(few), others = points_of(many);
    const auto most = static_cast<float>(tolerance_ * tolerance_);
    const bool one_by_one = some.size() * others.size() <= kFewPairs;
    return std::ranges::any_of(some, [&](const Point& point) {
      if (many.box.squaredExteriorDistance(point.getVector3fMap()) > most) return false;
      if (!one_by_one) return nearest_m2(many, point) <= most;
      return std::ranges::any_of(
          others, [&](const Point& other) { return squared_m2(point, other) <= most; });
    });
  }

  std::span<const Point> points_of(const Cube& cube) const {
    return std::span(distinct_).subspan(cube.from, cube.to - cube.from);
  }

  float nearest_m2(Cube& cube, const Point& point) const {
    if (!cube.tree) {
      const std::span<const Point> points = points_of(cube);
      pcl::PointCloud<Point>::Ptr cloud(new pcl::PointCloud<Point>);
      cloud->assign(points.begin(), points.end());
      cube.tree.reset(new pcl::KdTreeFLANN<Point>);
      cube.tree->setInputCloud(cloud);
    }
    pcl::Indices nearest(1);
    std::vector<float> squared(1);
    cube.tree->nearestKSearch(point, 1, nearest, squared);
    return squared.front();
  }

  std::size_t root(std::size_t cube) {
    while (parents_[cube] != cube) cube = parents_[cube] = parents_[parents_[cube]];
    return cube;
  }

  void join(std::size_t a, std::size_t b) {
    parents_[std::max(root(a), root(b))] = std::min(root(a), root(b));
  }

  std::span<const Point> points_;
  double tolerance_, side_;
  PointVector distinct_;  // by cubes
  std::vector<Cube> cubes_;
  std::vector<std::size_t> cube_of_point_, parents_;
};

}  // namespace

void roadbed_pcl_clusters(const float* xyz, std::size_t count, double tolerance, std::size_t least,
                          std::int32_t* cluster) {
  PointVector points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]});
  }
  const std::vector<std::size_t> found = Clustering(points, tolerance).clusters();
  std::vector<std::size_t> sizes(count, 0);
  for (const std::size_t of : found) ++sizes[of];
  std::vector<std::int32_t> numbers(count, -1);
  std::int32_t used = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::int32_t& number = numbers[found[i]];
    if (number < 0 && sizes[found[i]] >= least) number = used++;
    cluster[i] = number;
  }
}
