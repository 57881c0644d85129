#include "roadbed/map/occupancy/clearance/plan_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "roadbed/map/occupancy/clearance/distance_transform.h"
#include "roadbed/map/occupancy/clearance/rectangle_cover.h"

namespace roadbed::map::inline occupancy::inline clearance {
namespace {

CellWindow window_in(const CellRange& held, const CellRange& seen) {
  return {static_cast<std::size_t>(held.from_x - seen.from_x),
          static_cast<std::size_t>(held.from_y - seen.from_y),
          static_cast<std::size_t>(held.to_x - seen.from_x),
          static_cast<std::size_t>(held.to_y - seen.from_y)};
}

// Of whole bands of rows that the cells touch; the bits know of these cells.
bool any_in(const CellBits& bits, const CellRange& cells) {
  const std::int64_t last = floor_div(cells.to_y - 1, CellBits::kBandRows);
  for (std::int64_t band = floor_div(cells.from_y, CellBits::kBandRows); band <= last; ++band) {
    if (bits.any_in_band(band, cells.from_x, cells.to_x - 1)) return true;
  }
  return false;
}

// Of about a million cells each, one above the other.
std::vector<CellRange> strips_of(const CellRange& range) {
  constexpr std::int64_t at_once = 1 << 20;
  std::vector<CellRange> strips;
  if (range.empty()) return strips;
  const std::int64_t rows = std::max<std::int64_t>(1, at_once / range.width());
  for (std::int64_t y = range.from_y; y < range.to_y; y += rows) {
    strips.push_back({range.from_x, y, range.to_x, std::min(y + rows, range.to_y)});
  }
  return strips;
}

}  // namespace

PlanGrid::PlanGrid(const SlabsIn& slabs_in, const GridExtent& extent, std::int64_t layers,
                   double cell_m)
    : cell_m_(cell_m),
      per_cell_(1.0 / cell_m),
      extent_(extent),
      layers_(static_cast<std::uint16_t>(layers)) {
  std::vector<std::uint8_t> occupied;
  for (const CellRange& strip : strips_of(extent.seen)) {
    slabs_in(strip, [&](const Slab& slab) {
      if (is_blank()) {
        known_layers_.resize(extent.seen.count());
        occupied.resize(known_layers_.size());
      }
      paint(slab, strip, occupied);
    });
  }
  if (!is_blank()) occupied_ = layer_of(occupied);
}

// Leaves do not overlap, so that the layers of free ones add up.
void PlanGrid::paint(const Slab& slab, const CellRange& range,
                     std::vector<std::uint8_t>& occupied) {
  const CellRange cells = slab.cells.cut(range);
  if (cells.empty()) return;
  for (std::int64_t y = cells.from_y; y < cells.to_y; ++y) {
    std::size_t i = extent_.seen.index(cells.from_x, y);
    for (std::int64_t x = cells.from_x; x < cells.to_x; ++x, ++i) {
      if (slab.occupied) occupied[i] = 1;
      const auto known = static_cast<std::uint16_t>(known_layers_[i] + slab.layers);
      known_layers_[i] = occupied[i] != 0 ? layers_ : known;
    }
  }
}

PlanGrid::Layer PlanGrid::layer_of(const std::vector<std::uint8_t>& set) const {
  const CellRange& seen = extent_.seen;
  if (seen.empty()) return {};
  return {CellBits(seen, set),
          distances_to_set(set, static_cast<std::size_t>(seen.width()),
                           static_cast<std::size_t>(seen.height()), window_in(extent_.held, seen))};
}

// Distances to unknown cells are made when first asked for: the planner never does.
const PlanGrid::Layer& PlanGrid::layer(ObstacleKind kind) const {
  if (kind == ObstacleKind::occupied) return occupied_;
  std::call_once(unknown_once_, [this] {
    std::vector<std::uint8_t> unknown(known_layers_.size());
    for (std::size_t i = 0; i < unknown.size(); ++i) unknown[i] = known_layers_[i] < layers_;
    unknown_ = layer_of(unknown);
  });
  return unknown_;
}

PlanGrid::Cell PlanGrid::cell_at(const Eigen::Vector2d& point) const {
  return {whole_below(point.x() * per_cell_), whole_below(point.y() * per_cell_)};
}

// From the point to its cell's centre, on to the obstacle's centre, and back off its corner.
double PlanGrid::bound_m(const Cell& cell, const Eigen::Vector2d& point, const Layer& layer) const {
  const double between_m =
      static_cast<double>(layer.distances[extent_.held.index(cell.x, cell.y)]) * cell_m_;
  const double half_diagonal_m = cell_m_ * std::sqrt(0.5);
  return std::max(0.0, between_m - (point - centre(cell.x, cell.y)).norm() - half_diagonal_m);
}

double PlanGrid::lower_bound_m(const Eigen::Vector2d& point, ObstacleKind kind) const {
  if (is_blank()) {
    return kind == ObstacleKind::unknown ? 0.0 : std::numeric_limits<double>::infinity();
  }
  const Cell cell = cell_at(point);
  if (!extent_.held.holds(cell.x, cell.y)) return bound_from_outside_m(point, kind);
  const double inside_m = bound_m(cell, point, layer(kind));
  if (kind == ObstacleKind::occupied || !extent_.is_all) return inside_m;
  const Eigen::Vector2d from(static_cast<double>(extent_.seen.from_x) * cell_m_,
                             static_cast<double>(extent_.seen.from_y) * cell_m_);
  const Eigen::Vector2d to(static_cast<double>(extent_.seen.to_x) * cell_m_,
                           static_cast<double>(extent_.seen.to_y) * cell_m_);
  const double to_border_m = std::min((point - from).minCoeff(), (to - point).minCoeff());
  return std::clamp(to_border_m, 0.0, inside_m);
}

double PlanGrid::bound_from_outside_m(const Eigen::Vector2d& point, ObstacleKind kind) const {
  const CellRange& held = extent_.held;
  if (kind == ObstacleKind::unknown && extent_.is_all) return 0.0;
  if (held.empty()) return std::numeric_limits<double>::infinity();
  const Eigen::Vector2d inside = point
                                     .cwiseMax(Eigen::Vector2d(static_cast<double>(held.from_x),
                                                               static_cast<double>(held.from_y)) *
                                               cell_m_)
                                     .cwiseMin(Eigen::Vector2d(static_cast<double>(held.to_x),
                                                               static_cast<double>(held.to_y)) *
                                               cell_m_);
  const Cell at = cell_at(inside);
  const Cell cell{std::clamp(at.x, held.from_x, held.to_x - 1),
                  std::clamp(at.y, held.from_y, held.to_y - 1)};
  const double inside_m = bound_m(cell, inside, layer(kind));
  // The grid is convex: seen from outside, what lies in it is behind the nearest place of it.
  if (extent_.is_all) return std::hypot((point - inside).norm(), inside_m);
  return std::max(0.0, inside_m - (point - inside).norm());
}

// To the nearest cell's centre, around which a circle lies in it.
double PlanGrid::upper_bound_m(const Eigen::Vector2d& point, const Layer& layer) const {
  const Cell cell = cell_at(point);
  if (!extent_.held.holds(cell.x, cell.y)) return std::numeric_limits<double>::infinity();
  const double between_m =
      static_cast<double>(layer.distances[extent_.held.index(cell.x, cell.y)]) * cell_m_;
  constexpr double float_rounding = 1e-6;
  const double to_centre_m =
      between_m * (1.0 + float_rounding) + (point - centre(cell.x, cell.y)).norm();
  return std::max(0.0, to_centre_m - 0.5 * cell_m_ * (1.0 - float_rounding));
}

// Upper bound of the distance from the nearest cell, by points of the rectangle.
double PlanGrid::reach_m(const geometry::Rectangle& rectangle, double within_m,
                         const Layer& layer) const {
  constexpr double few_rows_m = 0.5;  // where more points cost more than they save
  double reach_m = within_m;
  if (reach_m <= few_rows_m) return reach_m;
  const Eigen::Vector2d ahead = rectangle.half_length_m * rectangle.axis;
  const Eigen::Vector2d left =
      rectangle.half_width_m * Eigen::Vector2d(-rectangle.axis.y(), rectangle.axis.x());
  for (const double fraction : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector2d point = rectangle.centre + fraction * ahead + side * left;
      reach_m = std::min(reach_m, upper_bound_m(point, layer));
    }
  }
  return reach_m;
}

// All cells are unknown: those that the rectangle may touch are enough to find the one that a grid
// of all would tell.
NearCell PlanGrid::nearest_in_blank(const geometry::Rectangle& rectangle) const {
  const CellRange touched = RectangleCover::cells_touched(rectangle, cell_m_).grown(1);
  const CellBits all(touched, std::vector<std::uint8_t>(touched.count(), 1));
  return *nearest_set_cell(all, cell_m_, rectangle, 0.0);
}

std::optional<NearCell> PlanGrid::nearest_inside(const geometry::Rectangle& rectangle,
                                                 double within_m, ObstacleKind kind) const {
  if (is_blank()) {
    if (kind == ObstacleKind::occupied || extent_.seen.empty()) return std::nullopt;
    return nearest_in_blank(rectangle);
  }
  if (extent_.seen.empty()) return std::nullopt;
  const Layer& cells = layer(kind);
  const Cell cell = cell_at(rectangle.centre);
  if (extent_.held.holds(cell.x, cell.y)) {
    const double bound_m_ = bound_m(cell, rectangle.centre, cells);
    if (bound_m_ > within_m + rectangle.radius_m()) return std::nullopt;
  }
  return nearest_set_cell(cells.bits, cell_m_, rectangle, reach_m(rectangle, within_m, cells));
}

// All space around the grid is unknown; the cell beside the nearest border stands for it.
NearCell PlanGrid::nearest_outside(const geometry::Rectangle& rectangle) const {
  NearCell least{std::numeric_limits<double>::infinity(), 0, 0};
  const auto consider = [&](double inset_m, const Eigen::Vector2d& outside) {
    if (inset_m >= least.distance_m) return;
    const Cell cell = cell_at(outside);
    least = {std::max(inset_m, 0.0), cell.x, cell.y};
  };
  const CellRange& seen = extent_.seen;
  const double from_x = static_cast<double>(seen.from_x) * cell_m_,
               from_y = static_cast<double>(seen.from_y) * cell_m_,
               to_x = static_cast<double>(seen.to_x) * cell_m_,
               to_y = static_cast<double>(seen.to_y) * cell_m_, half = 0.5 * cell_m_;
  for (const Eigen::Vector2d& corner : rectangle.corners()) {
    const double x = corner.x(), y = corner.y();
    consider(x - from_x, {std::min(x, from_x - half), y});
    consider(y - from_y, {x, std::min(y, from_y - half)});
    consider(to_x - x, {std::max(x, to_x + half), y});
    consider(to_y - y, {x, std::max(y, to_y + half)});
  }
  return least;
}

std::optional<NearCell> PlanGrid::nearest(const geometry::Rectangle& rectangle, double within_m,
                                          ObstacleKind kind) const {
  const auto inside = nearest_inside(rectangle, within_m, kind);
  if (kind == ObstacleKind::occupied || !extent_.is_all) return inside;
  const NearCell outside = nearest_outside(rectangle);
  if (inside && inside->distance_m <= outside.distance_m) return inside;
  if (outside.distance_m > within_m) return std::nullopt;
  return outside;
}

// Needs no distances to unknown cells, which cost more to make than these.
const PlanGrid::Measured& PlanGrid::measured() const {
  std::call_once(measured_once_, [this] {
    std::vector<std::uint8_t> set(known_layers_.size());
    const auto bits_where = [&](auto holds) {
      for (std::size_t i = 0; i < set.size(); ++i) set[i] = holds(known_layers_[i]);
      return CellBits(extent_.seen, set);
    };
    measured_ = {bits_where([](std::uint16_t known) { return known > 0; }),
                 bits_where([this](std::uint16_t known) { return known < layers_; })};
  });
  return measured_;
}

// A body mostly is over measured space: the search goes farther only where it is not.
std::optional<NearCell> PlanGrid::nearest_measured(const geometry::Rectangle& rectangle,
                                                   double within_m) const {
  if (is_blank()) return std::nullopt;
  const CellBits& cells = measured().in_part;
  if (auto under = nearest_set_cell(cells, cell_m_, rectangle, 0.0)) return under;
  return nearest_set_cell(cells, cell_m_, rectangle, within_m);
}

std::vector<NearCell> PlanGrid::cells_at(const geometry::Rectangle& rectangle,
                                         ObstacleKind kind) const {
  const bool is_unknown = kind == ObstacleKind::unknown;
  std::vector<NearCell> cells;
  const CellRange touched = RectangleCover::cells_touched(rectangle, cell_m_);
  for (std::int64_t y = touched.from_y; y < touched.to_y; ++y) {
    for (std::int64_t x = touched.from_x; x < touched.to_x; ++x) {
      const bool is_seen = !is_blank() && extent_.seen.holds(x, y);
      const bool holds = is_unknown ? !is_seen || known_layers_[extent_.seen.index(x, y)] < layers_
                                    : is_seen && occupied_.bits.next_in_row(y, x, x).has_value();
      if (holds) cells.push_back({0.0, x, y});
    }
  }
  return cells;
}

bool PlanGrid::is_any_unknown(const CellRange& cells) const {
  if (is_blank()) return true;
  const CellRange inside = cells.cut(extent_.seen);
  return inside.count() < cells.count() || any_in(measured().not_in_all, inside);
}

bool PlanGrid::is_any_measured(const CellRange& cells) const {
  if (is_blank()) return false;
  const CellRange inside = cells.cut(extent_.seen);
  return !inside.empty() && any_in(measured().in_part, inside);
}

// How many cells' worth of a rectangle's part of the band were never measured. Column by column, so
// that many of them are added up at once.
double PlanGrid::unknown_cells(const RectangleCover& cover) const {
  const CellRange& cells = cover.range();
  const CellRange inside = cells.cut(extent_.seen);
  const auto width = static_cast<std::size_t>(cells.width());
  std::vector<std::uint16_t> known(width);
  std::vector<double> by_column(width);
  for (std::int64_t y = cells.from_y; y < cells.to_y; ++y) {
    std::ranges::fill(known, std::uint16_t{0});
    if (!inside.empty() && y >= inside.from_y && y < inside.to_y) {
      std::copy_n(&known_layers_[extent_.seen.index(inside.from_x, y)], inside.width(),
                  &known[static_cast<std::size_t>(inside.from_x - cells.from_x)]);
    }
    const double* fractions = cover.row(y);
    for (std::size_t i = 0; i < width; ++i) by_column[i] += fractions[i] * (layers_ - known[i]);
  }
  return std::accumulate(by_column.begin(), by_column.end(), 0.0) / layers_;
}

double PlanGrid::unknown_fraction(const geometry::Rectangle& rectangle) const {
  const CellRange touched = RectangleCover::cells_touched(rectangle, cell_m_);
  if (!is_any_unknown(touched)) return 0.0;
  if (!is_any_measured(touched)) return 1.0;
  const double whole = 4.0 * rectangle.half_length_m * rectangle.half_width_m / (cell_m_ * cell_m_);
  return std::min(1.0, unknown_cells(RectangleCover(rectangle, cell_m_)) / whole);
}

}  // namespace roadbed::map::occupancy::clearance
