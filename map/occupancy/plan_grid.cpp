#include "roadbed/map/occupancy/plan_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/map/occupancy/distance_transform.h"

namespace roadbed::map {

CellRange CellRange::cut(const CellRange& other) const {
  return {std::max(from_x, other.from_x), std::max(from_y, other.from_y),
          std::min(to_x, other.to_x), std::min(to_y, other.to_y)};
}

CellRange CellRange::joined(const CellRange& other) const {
  if (empty()) return other;
  return {std::min(from_x, other.from_x), std::min(from_y, other.from_y),
          std::max(to_x, other.to_x), std::max(to_y, other.to_y)};
}

PlanGrid::PlanGrid(const std::vector<Slab>& slabs, const CellRange& range, std::int64_t layers,
                   double cell_m)
    : cell_m_(cell_m),
      width_(range.width()),
      height_(range.height()),
      layers_(static_cast<std::uint16_t>(layers)),
      known_layers_(static_cast<std::size_t>(width_ * height_)) {
  std::vector<std::uint8_t> occupied(known_layers_.size());
  for (const Slab& slab : slabs) paint(slab, range, occupied);
  to_occupied_ = distances_to_set(occupied, static_cast<std::size_t>(width_),
                                  static_cast<std::size_t>(height_));
}

// Leaves do not overlap, so that the layers of free ones add up.
void PlanGrid::paint(const Slab& slab, const CellRange& range,
                     std::vector<std::uint8_t>& occupied) {
  has_occupied_ = has_occupied_ || slab.occupied;
  for (std::int64_t y = slab.cells.from_y; y < slab.cells.to_y; ++y) {
    for (std::int64_t x = slab.cells.from_x; x < slab.cells.to_x; ++x) {
      const std::size_t i = index({x - range.from_x, y - range.from_y});
      if (slab.occupied) occupied[i] = 1;
      const auto known = static_cast<std::uint16_t>(known_layers_[i] + slab.layers);
      known_layers_[i] = occupied[i] != 0 ? layers_ : known;
    }
  }
}

Eigen::Vector2d PlanGrid::size_m() const {
  return {static_cast<double>(width_) * cell_m_, static_cast<double>(height_) * cell_m_};
}

Eigen::Vector2d PlanGrid::centre(const Cell& cell) const {
  return {(static_cast<double>(cell.first) + 0.5) * cell_m_,
          (static_cast<double>(cell.second) + 0.5) * cell_m_};
}

PlanGrid::Cell PlanGrid::cell_at(const Eigen::Vector2d& point) const {
  return {static_cast<std::int64_t>(std::floor(point.x() / cell_m_)),
          static_cast<std::int64_t>(std::floor(point.y() / cell_m_))};
}

PlanGrid::Cell PlanGrid::clamped(Cell cell) const {
  return {std::clamp<std::int64_t>(cell.first, 0, width_ - 1),
          std::clamp<std::int64_t>(cell.second, 0, height_ - 1)};
}

// Distances to unknown cells are made when first asked for: the planner never does.
const std::vector<float>& PlanGrid::distances(ObstacleKind kind) const {
  if (kind == ObstacleKind::occupied) return to_occupied_;
  std::call_once(unknown_once_, [this] {
    std::vector<std::uint8_t> unknown(known_layers_.size());
    for (std::size_t i = 0; i < unknown.size(); ++i) unknown[i] = known_layers_[i] < layers_;
    to_unknown_ = distances_to_set(unknown, static_cast<std::size_t>(width_),
                                   static_cast<std::size_t>(height_));
  });
  return to_unknown_;
}

// From the point to its cell's centre, on to the obstacle's centre, and back off its corner.
double PlanGrid::bound_inside(const Eigen::Vector2d& point, ObstacleKind kind) const {
  const Cell cell = clamped(cell_at(point));
  const double between_centres = static_cast<double>(distances(kind)[index(cell)]) * cell_m_;
  return std::max(0.0, between_centres - (point - centre(cell)).norm() - cell_m_ * std::sqrt(0.5));
}

double PlanGrid::upper_bound_m(const Eigen::Vector2d& point, ObstacleKind kind) const {
  const Cell cell = clamped(cell_at(point));
  const double between_centres = static_cast<double>(distances(kind)[index(cell)]) * cell_m_;
  constexpr double float_rounding = 1e-6;
  return between_centres * (1.0 + float_rounding) + (point - centre(cell)).norm();
}

double PlanGrid::lower_bound_m(const Eigen::Vector2d& point, ObstacleKind kind) const {
  if (empty()) {
    return kind == ObstacleKind::unknown ? 0.0 : std::numeric_limits<double>::infinity();
  }
  const Eigen::Vector2d inside = point.cwiseMax(0.0).cwiseMin(size_m());
  const double bound_m = bound_inside(inside, kind);
  if (kind == ObstacleKind::occupied && inside == point) return bound_m;
  if (kind == ObstacleKind::unknown) {
    const double to_border_m = std::min(point.minCoeff(), (size_m() - point).minCoeff());
    return std::clamp(to_border_m, 0.0, bound_m);
  }
  // The grid is convex: seen from outside, what lies in it is behind the nearest place of it.
  return std::hypot((point - inside).norm(), bound_m);
}

/// Goes row by row through the cells in reach, jumping as far as the distances allow.
struct PlanGrid::Search {
  const PlanGrid& grid;
  const geometry::Rectangle& rectangle;
  const Eigen::Vector2d half_extent = half_extent_m(rectangle);
  const std::vector<float>& distance;
  double reach_m;
  std::optional<Cell> best;

  void run() {
    const auto [from_y, to_y] = span(1, grid.height_);
    for (std::int64_t y = from_y; y <= to_y; ++y) {
      const double gap_m = std::abs(grid.centre({0, y}).y() - rectangle.centre.y()) -
                           half_extent.y() - 0.5 * grid.cell_m_;
      if (gap_m <= reach_m) search_row(y);
      if (best && reach_m == 0.0) return;
    }
  }

  void search_row(std::int64_t y) {
    const auto [from_x, to_x] = span(0, grid.width_);
    for (std::int64_t x = from_x; x <= to_x;) {
      const float cells = distance[grid.index({x, y})];
      if (cells > static_cast<float>(to_x - x)) return;
      if (cells == 0.0f) consider({x, y});
      x += std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(cells)));
    }
  }

  void consider(const Cell& cell) {
    const double gap_m = distance_to_square_m(rectangle, grid.centre(cell), 0.5 * grid.cell_m_);
    if (gap_m < reach_m || (!best && gap_m <= reach_m)) {
      reach_m = gap_m;
      best = cell;
    }
  }

  // Rows or columns within reach, and one more against rounding.
  std::pair<std::int64_t, std::int64_t> span(int axis, std::int64_t count) const {
    const auto cell = [&](double at_m) {
      const double limit = static_cast<double>(count - 1);
      return static_cast<std::int64_t>(std::clamp(std::floor(at_m / grid.cell_m_), 0.0, limit));
    };
    const double middle = rectangle.centre[axis];
    const double half = half_extent[axis] + reach_m + grid.cell_m_;
    return {cell(middle - half), cell(middle + half)};
  }
};

std::optional<PlanGrid::NearestCell> PlanGrid::nearest_inside(const geometry::Rectangle& rectangle,
                                                              double within_m,
                                                              ObstacleKind kind) const {
  if (empty()) return std::nullopt;
  Search search{.grid = *this,
                .rectangle = rectangle,
                .distance = distances(kind),
                .reach_m = std::min(within_m, upper_bound_m(rectangle.centre, kind)),
                .best = std::nullopt};
  for (const Eigen::Vector2d& corner : rectangle.corners()) {
    search.reach_m = std::min(search.reach_m, upper_bound_m(corner, kind));
  }
  search.run();
  if (!search.best) return std::nullopt;
  return NearestCell{search.reach_m, *search.best};
}

// All space around the grid is unknown; the cell beside the nearest border stands for it.
PlanGrid::NearestCell PlanGrid::nearest_outside(const geometry::Rectangle& rectangle) const {
  NearestCell least{std::numeric_limits<double>::infinity(), {0, 0}};
  const auto consider = [&](double inset_m, const Eigen::Vector2d& outside) {
    if (inset_m >= least.distance_m) return;
    least = {std::max(inset_m, 0.0), cell_at(outside)};
  };
  const Eigen::Vector2d end = size_m();
  const double half = 0.5 * cell_m_;
  for (const Eigen::Vector2d& corner : rectangle.corners()) {
    consider(corner.x(), {std::min(corner.x(), -half), corner.y()});
    consider(corner.y(), {corner.x(), std::min(corner.y(), -half)});
    consider(end.x() - corner.x(), {std::max(corner.x(), end.x() + half), corner.y()});
    consider(end.y() - corner.y(), {corner.x(), std::max(corner.y(), end.y() + half)});
  }
  return least;
}

std::optional<PlanGrid::NearestCell> PlanGrid::nearest(const geometry::Rectangle& rectangle,
                                                       double within_m, ObstacleKind kind) const {
  const auto inside = nearest_inside(rectangle, within_m, kind);
  if (kind == ObstacleKind::occupied) return inside;
  const NearestCell outside = nearest_outside(rectangle);
  if (inside && inside->distance_m <= outside.distance_m) return inside;
  if (outside.distance_m > within_m) return std::nullopt;
  return outside;
}

double PlanGrid::measured_share(const Cell& cell) const {
  if (!holds(cell)) return 0.0;
  return static_cast<double>(known_layers_[index(cell)]) / layers_;
}

}  // namespace roadbed::map
