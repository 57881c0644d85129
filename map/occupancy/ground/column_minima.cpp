#include "roadbed/map/occupancy/ground/column_minima.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline occupancy::inline ground {
namespace {

using Eigen::Vector2d;

constexpr std::int64_t kSide = 32;              // columns of a tile
constexpr std::size_t kMostKeptTiles = 50'000;  // 200 MB
constexpr double kFarthestColumn = 1e8;         // from the origin; no octree reaches there

std::int64_t tile_of_column(std::int64_t column) {
  return column >= 0 ? column / kSide : -((kSide - 1 - column) / kSide);
}

std::int64_t key_of_tile(std::int64_t x, std::int64_t y) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(x) << 32 |
                                   static_cast<std::uint32_t>(y));
}

std::size_t index_in_tile(std::int64_t x, std::int64_t y) {
  return static_cast<std::size_t>((y - tile_of_column(y) * kSide) * kSide + x -
                                  tile_of_column(x) * kSide);
}

}  // namespace

ColumnMinima::ColumnMinima(const map::OccupancySource& occupancy,
                           const std::vector<Vector2d>& points, double radius_m)
    : cell_m_(occupancy.resolution_m()),
      radius_m_(radius_m),
      origin_(occupancy.origin_in_source()) {
  Vector2d least = points.front(), most = least;
  const Vector2d margin = Vector2d::Constant(radius_m + cell_m_);
  for (const Vector2d& point : points) {
    want(columns_around(point));
    least = least.cwiseMin(point - margin);
    most = most.cwiseMax(point + margin);
  }
  constexpr double any_height_m = 1e6;
  const map::Box3 around{{least.x(), least.y(), -any_height_m}, {most.x(), most.y(), any_height_m}};
  occupancy.for_each_in(around, [this](const map::OccupancyCell& leaf) {
    if (leaf.state == map::CellState::occupied) add(leaf);
  });
}

ColumnMinima::Columns ColumnMinima::columns_around(const Vector2d& point) const {
  const Vector2d from = (point - origin_.head<2>()).array() - radius_m_;
  const auto column = [this](double at_m) {
    return static_cast<Column>(
        std::clamp(std::floor(at_m / cell_m_), -kFarthestColumn, kFarthestColumn));
  };
  return {column(from.x()), column(from.y()), column(from.x() + 2.0 * radius_m_) + 1,
          column(from.y() + 2.0 * radius_m_) + 1};
}

void ColumnMinima::want(const Columns& columns) {
  for (Column y = tile_of_column(columns.from_y); y * kSide < columns.to_y; ++y) {
    for (Column x = tile_of_column(columns.from_x); x * kSide < columns.to_x; ++x) {
      std::vector<float>& tile = tiles_[key_of_tile(x, y)];
      if (tile.empty()) tile.resize(kSide * kSide, std::numeric_limits<float>::infinity());
      if (tiles_.size() <= kMostKeptTiles) continue;
      throw map::InputError({.file = "ground",
                             .found = fmt::format("the drive has over {} columns of cells around",
                                                  tiles_.size() * kSide * kSide),
                             .remedy = "cut the drive, or build coarser cells"});
    }
  }
}

void ColumnMinima::add(const map::OccupancyCell& leaf) {
  const Eigen::Vector3d least = (leaf.centre_in_source - origin_).array() - 0.5 * leaf.size_m;
  const auto column = [this](double at_m) {
    return static_cast<Column>(std::llround(at_m / cell_m_));
  };
  const Column side = column(leaf.size_m);
  const Columns columns{column(least.x()), column(least.y()), column(least.x()) + side,
                        column(least.y()) + side};
  const double z_m = least.z() + 0.5 * cell_m_;
  const Column from_x = tile_of_column(columns.from_x), from_y = tile_of_column(columns.from_y);
  const Column to_x = tile_of_column(columns.to_x - 1), to_y = tile_of_column(columns.to_y - 1);
  if ((to_x - from_x + 1) * (to_y - from_y + 1) > static_cast<Column>(tiles_.size())) {
    for (auto& [key, tile] : tiles_)
      add(tile, {key >> 32, static_cast<std::int32_t>(key)}, columns, z_m);
    return;
  }
  for (Column y = from_y; y <= to_y; ++y) {
    for (Column x = from_x; x <= to_x; ++x) {
      const auto tile = tiles_.find(key_of_tile(x, y));
      if (tile != tiles_.end()) add(tile->second, {x, y}, columns, z_m);
    }
  }
}

void ColumnMinima::add(std::vector<float>& tile, const std::pair<Column, Column>& at,
                       const Columns& columns, double z_m) const {
  const Column first_x = at.first * kSide, first_y = at.second * kSide;
  for (Column y = std::max(columns.from_y, first_y); y < std::min(columns.to_y, first_y + kSide);
       ++y) {
    for (Column x = std::max(columns.from_x, first_x); x < std::min(columns.to_x, first_x + kSide);
         ++x) {
      float& lowest_m = tile[index_in_tile(x, y)];
      lowest_m = std::min(lowest_m, static_cast<float>(z_m));
    }
  }
}

std::vector<Eigen::Vector3d> ColumnMinima::around(const Vector2d& point) const {
  std::vector<Eigen::Vector3d> found;
  const Columns columns = columns_around(point);
  for (Column y = columns.from_y; y < columns.to_y; ++y) {
    for (Column x = columns.from_x; x < columns.to_x; ++x) {
      const auto tile = tiles_.find(key_of_tile(tile_of_column(x), tile_of_column(y)));
      if (tile == tiles_.end()) continue;
      const float z_m = tile->second[index_in_tile(x, y)];
      const Eigen::Vector3d middle =
          origin_ + Eigen::Vector3d((static_cast<double>(x) + 0.5) * cell_m_,
                                    (static_cast<double>(y) + 0.5) * cell_m_, z_m);
      if (!std::isfinite(z_m) || (middle.head<2>() - point).norm() > radius_m_) continue;
      found.push_back(middle);
    }
  }
  return found;
}

}  // namespace roadbed::map::occupancy::ground
