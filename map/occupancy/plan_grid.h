#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "roadbed/map/occupancy/clearance_field.h"
#include "roadbed/map/occupancy/rectangle_on_grid.h"

namespace roadbed::map {

/// Cells in plan view, counted from the occupancy's origin, half open.
struct CellRange {
  std::int64_t from_x = 0, from_y = 0, to_x = 0, to_y = 0;

  std::int64_t width() const { return to_x - from_x; }
  std::int64_t height() const { return to_y - from_y; }
  bool empty() const { return width() <= 0 || height() <= 0; }
  CellRange cut(const CellRange& other) const;
  CellRange joined(const CellRange& other) const;
};

/// A leaf of the octree within a height band: its cells, and how many layers of the band it fills.
struct Slab {
  CellRange cells;
  std::int64_t layers;
  bool occupied;
};

/// A grid in plan view: which cells are occupied, how much of each was measured, and how far away
/// the next occupied or unknown one is. Coordinates are metres from the grid's lower left corner.
class PlanGrid {
 public:
  using Cell = std::pair<std::int64_t, std::int64_t>;
  struct NearestCell {
    double distance_m;
    Cell cell;  ///< may lie just outside the grid, where all is unknown
  };

  PlanGrid(const std::vector<Slab>& slabs, const CellRange& range, std::int64_t layers,
           double cell_m);

  double cell_m() const { return cell_m_; }
  bool empty() const { return width_ == 0; }
  bool has_occupied() const { return has_occupied_; }
  Eigen::Vector2d centre(const Cell& cell) const;

  /// Lower bound of the distance from a point to the nearest cell of the kind.
  double lower_bound_m(const Eigen::Vector2d& point, ObstacleKind kind) const;

  /// Exact distance from a rectangle; none if it is over `within_m`.
  std::optional<NearestCell> nearest(const geometry::Rectangle& rectangle, double within_m,
                                     ObstacleKind kind) const;

  /// Share of the cell's part of the band that was measured; 1 where a layer is occupied.
  double measured_share(const Cell& cell) const;

 private:
  struct Search;

  std::size_t index(const Cell& cell) const {
    return static_cast<std::size_t>(cell.second * width_ + cell.first);
  }
  bool holds(const Cell& cell) const {
    return cell.first >= 0 && cell.second >= 0 && cell.first < width_ && cell.second < height_;
  }
  Eigen::Vector2d size_m() const;
  Cell cell_at(const Eigen::Vector2d& point) const;
  Cell clamped(Cell cell) const;
  void paint(const Slab& slab, const CellRange& range, std::vector<std::uint8_t>& occupied);
  const std::vector<float>& distances(ObstacleKind kind) const;
  double bound_inside(const Eigen::Vector2d& point, ObstacleKind kind) const;
  double upper_bound_m(const Eigen::Vector2d& point, ObstacleKind kind) const;
  NearestCell nearest_outside(const geometry::Rectangle& rectangle) const;
  std::optional<NearestCell> nearest_inside(const geometry::Rectangle& rectangle, double within_m,
                                            ObstacleKind kind) const;

  double cell_m_;
  std::int64_t width_, height_;
  std::uint16_t layers_;
  bool has_occupied_ = false;
  std::vector<std::uint16_t> known_layers_;  // all of them where one is occupied
  std::vector<float> to_occupied_;           // in cells, from centre to centre
  mutable std::once_flag unknown_once_;
  mutable std::vector<float> to_unknown_;
};

}  // namespace roadbed::map
