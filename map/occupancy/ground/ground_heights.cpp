#include "roadbed/map/occupancy/ground/ground_heights.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <unordered_map>

namespace roadbed::map::inline occupancy::inline ground {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr double kAroundM = 2.0;    // columns this near speak of a point
constexpr double kTileM = 2.0;      // or a column: points in tiles near to those asked for are kept
constexpr double kLeastM = 0.25;    // side of a column
constexpr double kLayerM = 0.2;     // thickness of what is lowest in a column
constexpr double kOnGroundM = 0.1;  // off the plane, of columns that are on it
constexpr double kSteepestPlane = 0.35;
constexpr double kFewestOn = 0.3;  // of all columns around
constexpr std::size_t kFewestColumns = 8, kDirections = 8, kFewestDirections = 6;

/// Cells of a square grid, in rows along x.
class Grid {
 public:
  explicit Grid(double side_m) : side_m_(side_m) {}

  std::int64_t number(double at_m) const {
    return static_cast<std::int64_t>(std::floor(at_m / side_m_));
  }
  std::int64_t cell(const Vector2d& at) const { return cell(number(at.x()), number(at.y())); }
  // Cells of a row have numbers that follow each other; 2³¹ of them reach around the earth.
  static std::int64_t cell(std::int64_t x, std::int64_t y) { return y * kRow + x; }
  static Vector2d numbers(std::int64_t cell) {
    const std::int64_t y = (cell + kRow / 2) >> 32;
    return {static_cast<double>(cell - y * kRow), static_cast<double>(y)};
  }

 private:
  static constexpr std::int64_t kRow = std::int64_t{1} << 32;
  double side_m_;
};

struct Plane {
  double height_m = 0.0;  ///< at the point
  Vector2d slope{0, 0};

  double off_m(const Vector3d& from_point) const {
    return from_point.z() - height_m - slope.dot(from_point.head<2>());
  }
};

/// The lowest layer of each column near the points asked for.
class LowestLayer {
 public:
  LowestLayer(double side_m, std::span<const Vector2d> at)
      : side_m_(side_m), tile_m_(std::max(kTileM, side_m)), columns_(side_m), wanted_(tile_m_) {
    if (at.empty()) return;
    origin_ << at.front().array().round(), 0.0;
    const Vector2d reach = Vector2d::Constant(kAroundM + side_m);  // of whole columns
    for (const Vector2d& point : at) {
      const Vector2d local = point - origin_.head<2>();
      for_each_tile(local - reach, local + reach,
                    [&](std::int64_t tile) { wanted_cells_.try_emplace(tile, kNoLevel); });
    }
  }

  void add(const Vector3d& in_source) {
    const Vector3d local = in_source - origin_;
    if (!wanted_cells_.contains(wanted_.cell(local.head<2>()))) return;
    points_.push_back({columns_.cell(local.head<2>()), local.cast<float>()});
    if (points_.size() >= most_points_) drop_what_is_above();
  }

  // All of a level rectangle, however large: a point for each column at least.
  void add_level(const Vector2d& min, const Vector2d& max, double z_m) {
    const auto add_part = [&](const Vector2d& from, const Vector2d& to) {
      for (double x = from.x() + 0.5 * side_m_; x < to.x(); x += side_m_) {
        for (double y = from.y() + 0.5 * side_m_; y < to.y(); y += side_m_) add({x, y, z_m});
      }
    };
    if ((max - min).prod() < tile_m_ * tile_m_) return add_part(min, max);
    const auto add_in = [&](std::int64_t tile, double& level_m) {
      const Vector2d from = origin_.head<2>() + tile_m_ * Grid::numbers(tile);
      const Vector2d to = from + Vector2d::Constant(tile_m_);
      const bool is_all = (min.array() <= from.array()).all() && (to.array() <= max.array()).all();
      if (is_all && z_m > level_m + kLayerM) return;  // above another at the same points
      if (is_all) level_m = std::min(level_m, z_m);
      add_part(min.cwiseMax(from), max.cwiseMin(to));
    };
    const Vector2d tiles = (max - min) / tile_m_;
    if (tiles.prod() > static_cast<double>(wanted_cells_.size())) {
      for (auto& [tile, level_m] : wanted_cells_) add_in(tile, level_m);
      return;
    }
    for_each_tile(min - origin_.head<2>(), max - origin_.head<2>(), [&](std::int64_t tile) {
      const auto found = wanted_cells_.find(tile);
      if (found != wanted_cells_.end()) add_in(tile, found->second);
    });
  }

  void settle() {
    sort();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points_.size();) {
      const Point lowest = points_[i];
      Vector3d sum(0, 0, 0);
      std::size_t count = 0;
      for (; i < points_.size() && points_[i].column == lowest.column; ++i) {
        if (points_[i].local.z() > lowest.local.z() + kLayerM) continue;
        sum += points_[i].local.cast<double>();
        ++count;
      }
      sum /= static_cast<double>(count);
      points_[kept++] = {lowest.column, sum.cast<float>()};
    }
    points_.resize(kept);
  }

  // From the point asked for; z counts from 0.
  void around(const Vector2d& point_in_source, std::vector<Vector3d>& found) const {
    found.clear();
    const Vector2d at = point_in_source - origin_.head<2>();
    const auto x = columns_.number(at.x() - kAroundM), to_x = columns_.number(at.x() + kAroundM);
    const auto y = columns_.number(at.y() - kAroundM), to_y = columns_.number(at.y() + kAroundM);
    for (std::int64_t row = y; row <= to_y; ++row) {
      auto point = std::lower_bound(
          points_.begin(), points_.end(), Grid::cell(x, row),
          [](const Point& one, std::int64_t column) { return one.column < column; });
      for (; point != points_.end() && point->column <= Grid::cell(to_x, row); ++point) {
        const Vector3d local = point->local.cast<double>();
        const Vector3d from(local.x() - at.x(), local.y() - at.y(), local.z());
        if (from.head<2>().norm() < kAroundM) found.push_back(from);
      }
    }
  }

 private:
  struct Point {
    std::int64_t column;
    Eigen::Vector3f local;
  };

  static constexpr double kNoLevel = std::numeric_limits<double>::infinity();

  template <typename F>
  void for_each_tile(const Vector2d& from, const Vector2d& to, const F& f) const {
    for (auto y = wanted_.number(from.y()); y <= wanted_.number(to.y()); ++y) {
      for (auto x = wanted_.number(from.x()); x <= wanted_.number(to.x()); ++x) f(Grid::cell(x, y));
    }
  }

  void sort() {
    std::sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) {
      return a.column != b.column ? a.column < b.column : a.local.z() < b.local.z();
    });
  }

  // What is above a column's lowest layer now is above it at the end.
  void drop_what_is_above() {
    sort();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points_.size();) {
      const Point lowest = points_[i];
      for (; i < points_.size() && points_[i].column == lowest.column; ++i) {
        if (points_[i].local.z() <= lowest.local.z() + kLayerM) points_[kept++] = points_[i];
      }
    }
    points_.resize(kept);
    most_points_ = std::max(most_points_, 2 * kept);
  }

  double side_m_, tile_m_;
  Grid columns_, wanted_;
  Vector3d origin_{0, 0, 0};
  std::unordered_map<std::int64_t, double> wanted_cells_;  // and the lowest level that covers each
  std::vector<Point> points_;
  std::size_t most_points_ = 1'000'000;  // until those above others are dropped
};

Plane level_at_quarter(const std::vector<Vector3d>& columns) {
  std::vector<double> heights_m;
  for (const Vector3d& column : columns) heights_m.push_back(column.z());
  const auto quarter = heights_m.begin() + static_cast<std::ptrdiff_t>(heights_m.size() / 4);
  std::nth_element(heights_m.begin(), quarter, heights_m.end());
  return {*quarter, {0, 0}};
}

std::optional<Plane> plane_near(const std::vector<Vector3d>& columns, const Plane& last,
                                double within_m) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  std::size_t count = 0;
  for (const Vector3d& column : columns) {
    if (std::abs(last.off_m(column)) > within_m) continue;
    const double near = 1.0 - column.head<2>().squaredNorm() / (kAroundM * kAroundM);
    const Vector3d row(1.0, column.x(), column.y());
    normal += near * near * row * row.transpose();
    right += near * near * row * (column.z() - last.height_m);
    ++count;
  }
  if (count < kFewestColumns) return {};
  const Vector3d plane = normal.ldlt().solve(right);
  const Plane found{last.height_m + plane.x(), plane.tail<2>()};
  const bool is_ground = plane.allFinite() && found.slope.norm() <= kSteepestPlane;
  return is_ground ? std::optional(found) : std::nullopt;
}

bool is_all_around(const std::vector<Vector3d>& columns, const Plane& plane, double within_m) {
  std::array<bool, kDirections> seen{};
  std::size_t on = 0;
  for (const Vector3d& column : columns) {
    if (std::abs(plane.off_m(column)) > within_m) continue;
    ++on;
    const double turn = 0.5 + 0.5 * std::atan2(column.y(), column.x()) / std::numbers::pi;
    seen[static_cast<std::size_t>(turn * kDirections) % kDirections] = true;
  }
  const auto directions = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
  return static_cast<double>(on) >= kFewestOn * static_cast<double>(columns.size()) &&
         directions >= kFewestDirections;
}

std::optional<double> height_of(const std::vector<Vector3d>& columns, double cell_m) {
  if (columns.size() < kFewestColumns) return {};
  const double on_m = std::max(kOnGroundM, cell_m);
  Plane plane = level_at_quarter(columns);
  for (const double within_m : {0.6, 0.3, 1.5 * on_m, on_m, on_m, on_m}) {
    const auto next = plane_near(columns, plane, std::max(within_m, on_m));
    if (!next) return {};
    plane = *next;
  }
  return is_all_around(columns, plane, on_m) ? std::optional(plane.height_m) : std::nullopt;
}

std::vector<std::optional<double>> heights_on(const LowestLayer& layer,
                                              std::span<const Vector2d> at, double cell_m) {
  std::vector<std::optional<double>> heights_m;
  heights_m.reserve(at.size());
  std::vector<Vector3d> columns;
  for (const Vector2d& point : at) {
    layer.around(point, columns);
    heights_m.push_back(height_of(columns, cell_m));
  }
  return heights_m;
}

map::Box3 column_of(std::span<const Vector2d> at) {
  constexpr double any_height_m = 1e6;
  map::Box3 box{{at[0].x(), at[0].y(), -any_height_m}, {at[0].x(), at[0].y(), any_height_m}};
  for (const Vector2d& point : at) {
    box.min_in_source.head<2>() = box.min_in_source.head<2>().cwiseMin(point);
    box.max_in_source.head<2>() = box.max_in_source.head<2>().cwiseMax(point);
  }
  box.min_in_source.head<2>().array() -= kAroundM;
  box.max_in_source.head<2>().array() += kAroundM;
  return box;
}

}  // namespace

std::vector<std::optional<double>> ground_heights(std::span<const map::PointCloud> clouds,
                                                  std::span<const Vector2d> at_in_source) {
  LowestLayer layer(kLeastM, at_in_source);
  for (const map::PointCloud& cloud : clouds) {
    for (std::size_t i = 0; i < cloud.points.size(); ++i) layer.add(cloud.in_source(i));
  }
  layer.settle();
  return heights_on(layer, at_in_source, 0.0);
}

std::vector<std::optional<double>> ground_heights(const map::OccupancySource& occupancy,
                                                  std::span<const Vector2d> at_in_source) {
  const double cell_m = occupancy.resolution_m();
  LowestLayer layer(std::max(kLeastM, cell_m), at_in_source);
  if (at_in_source.empty()) return {};
  occupancy.for_each_in(column_of(at_in_source), [&](const map::OccupancyCell& leaf) {
    if (leaf.state != map::CellState::occupied) return;
    if (leaf.size_m < 1.5 * cell_m) return layer.add(leaf.centre_in_source);
    const Vector2d middle = leaf.centre_in_source.head<2>();
    const Vector2d half = Vector2d::Constant(0.5 * leaf.size_m);
    layer.add_level(middle - half, middle + half,
                    leaf.centre_in_source.z() - 0.5 * (leaf.size_m - cell_m));
  });
  layer.settle();
  return heights_on(layer, at_in_source, cell_m);
}

}  // namespace roadbed::map::occupancy::ground
