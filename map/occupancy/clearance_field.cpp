#include "roadbed/map/occupancy/clearance_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "roadbed/map/input_error.h"
#include "roadbed/map/occupancy/ground.h"
#include "roadbed/map/occupancy/levelled_slabs.h"
#include "roadbed/map/occupancy/plan_grid.h"
#include "roadbed/map/occupancy/rectangle_on_grid.h"

namespace roadbed::map {
namespace {

constexpr double kHorizon_m = 1000.0;
constexpr double kTouch_m = 1e-6;  // cells that overlap the band by less only touch it

/// Turns the octree's leaves into slabs.
class Slicer {
 public:
  Slicer(const OccupancyMap& occupancy, const HeightBand& band)
      : origin_(occupancy.origin_in_source()), cell_m_(occupancy.resolution_m()) {
    from_layer_ = to_cells(band.from_m + kTouch_m - origin_.z());
    to_layer_ = to_cells(band.to_m - kTouch_m - origin_.z()) + 1;
  }

  std::int64_t layers() const { return to_layer_ - from_layer_; }

  std::optional<Slab> slice(const OccupancyCell& leaf) const {
    const Eigen::Vector3d corner =
        (leaf.centre_in_source - origin_).array() - 0.5 * (leaf.size_m - cell_m_);
    const auto side = static_cast<std::int64_t>(std::llround(leaf.size_m / cell_m_));
    const std::int64_t x = to_cells(corner.x()), y = to_cells(corner.y()), z = to_cells(corner.z());
    const std::int64_t layers = std::min(z + side, to_layer_) - std::max(z, from_layer_);
    if (layers <= 0) return std::nullopt;
    return Slab{{x, y, x + side, y + side}, layers, leaf.state == CellState::occupied};
  }

  CellRange range(const Box2& box, double margin_m) const {
    const auto from = [&](double at, double origin) { return to_cells(at - margin_m - origin); };
    const auto to = [&](double at, double origin) { return to_cells(at + margin_m - origin) + 1; };
    return {from(box.min_in_source.x(), origin_.x()), from(box.min_in_source.y(), origin_.y()),
            to(box.max_in_source.x(), origin_.x()), to(box.max_in_source.y(), origin_.y())};
  }

 private:
  std::int64_t to_cells(double metres) const {
    return static_cast<std::int64_t>(std::floor(metres / cell_m_));
  }

  Eigen::Vector3d origin_;
  double cell_m_;
  std::int64_t from_layer_, to_layer_;
};

void check(const HeightBand& band) {
  constexpr double highest_m = 1e6;
  if (!(band.to_m - band.from_m > 2.0 * kTouch_m) || !(band.from_m > -highest_m) ||
      !(band.to_m < highest_m)) {
    throw std::invalid_argument(
        fmt::format("ClearanceField: band from {} m to {} m is empty", band.from_m, band.to_m));
  }
}

void check_size(const CellRange& range, std::int64_t layers, double cell_m) {
  constexpr auto most = static_cast<std::int64_t>(ClearanceField::kMostCells);
  constexpr std::int64_t longest = 65536;
  if (range.width() <= longest && range.height() <= longest && layers < longest &&
      range.width() * range.height() <= most) {
    return;
  }
  throw InputError({.file = "occupancy",
                    .place = {},
                    .element = "extent",
                    .found = fmt::format("{} × {} cells of {} m in {} layers", range.width(),
                                         range.height(), cell_m, layers),
                    .needed = fmt::format("at most {} cells, and {} a side", most, longest),
                    .remedy = "cut the occupancy, or take a coarser resolution"});
}

struct Slices {
  std::vector<Slab> slabs;
  CellRange range;  // of all slabs
};

// Over ground that is not level every column has layers of its own.
Slices slice_levelled(const OccupancyMap& occupancy, const HeightBand& band, const Slicer& slicer,
                      const FieldRegion& region) {
  const CellRange range = slicer.range(region.around, region.horizon_m);
  check_size(range, kLevelledLayers, occupancy.resolution_m());
  Slices slices{levelled_slabs(occupancy.cells(), band, occupancy.origin_in_source(),
                               occupancy.resolution_m(), range),
                {}};
  for (const Slab& slab : slices.slabs) slices.range = slices.range.joined(slab.cells);
  return slices;
}

Slices slice_all(const OccupancyMap& occupancy, const Slicer& slicer,
                 const std::optional<FieldRegion>& region) {
  Slices slices;
  for (const OccupancyCell& leaf : occupancy.cells()) {
    std::optional<Slab> slab = slicer.slice(leaf);
    if (slab && region) {
      slab->cells = slab->cells.cut(slicer.range(region->around, region->horizon_m));
    }
    if (!slab || slab->cells.empty()) continue;
    slices.range = slices.range.joined(slab->cells);
    slices.slabs.push_back(*slab);
  }
  return slices;
}

}  // namespace

struct ClearanceField::Grid {
  PlanGrid plan;
  Eigen::Vector2d corner_in_source;  // lower left of the grid's first cell
  double horizon_m;
  std::optional<Box2> around;

  Eigen::Vector2d in_grid(const Eigen::Vector2d& in_source) const {
    return in_source - corner_in_source;
  }

  geometry::Rectangle in_grid(geometry::Rectangle rectangle) const {
    rectangle.centre = in_grid(rectangle.centre);
    return rectangle;
  }

  // How far a point lies outside the region that queries should stay in.
  double beyond_around(const Eigen::Vector2d& in_source) const {
    if (!around) return 0.0;
    const Eigen::Vector2d inside =
        in_source.cwiseMax(around->min_in_source).cwiseMin(around->max_in_source);
    return (in_source - inside).norm();
  }

  void check_inside(const geometry::Rectangle& rectangle) const {
    for (const Eigen::Vector2d& corner : rectangle.corners()) {
      const Eigen::Vector2d in_source = corner + corner_in_source;
      constexpr double rounding_m = 1e-6;
      if (beyond_around(in_source) <= rounding_m) continue;
      throw std::invalid_argument(fmt::format(
          "ClearanceField: the vehicle's corner ({}, {}) leaves the region of the field",
          in_source.x(), in_source.y()));
    }
  }

  Box2 box_of(const PlanGrid::Cell& cell) const {
    const Eigen::Array2d middle = corner_in_source + plan.centre(cell);
    return {middle - 0.5 * plan.cell_m(), middle + 0.5 * plan.cell_m()};
  }
};

bool HeightBand::holds(const Eigen::Vector2d& in_source, double low_m, double height_m) const {
  const double above_m = ground ? low_m - ground->height_m(in_source) : low_m;
  return std::min(above_m + height_m, to_m) - std::max(above_m, from_m) > kTouch_m;
}

ClearanceField::ClearanceField(const OccupancyMap& occupancy, const HeightBand& band,
                               const std::optional<FieldRegion>& region) {
  check(band);
  const Slicer slicer(occupancy, band);
  if (band.ground && !region) {
    throw std::invalid_argument("ClearanceField: a band over a ground needs a region");
  }
  const Slices slices = band.ground ? slice_levelled(occupancy, band, slicer, *region)
                                    : slice_all(occupancy, slicer, region);
  const std::int64_t layers = band.ground ? kLevelledLayers : slicer.layers();
  const double cell_m = occupancy.resolution_m();
  check_size(slices.range, layers, cell_m);
  const Eigen::Vector2d first_cell(static_cast<double>(slices.range.from_x),
                                   static_cast<double>(slices.range.from_y));
  grid_.reset(new Grid{
      .plan = PlanGrid(slices.slabs, slices.range, layers, cell_m),
      .corner_in_source = occupancy.origin_in_source().head<2>() + cell_m * first_cell,
      .horizon_m = region ? std::min(region->horizon_m, kHorizon_m) : kHorizon_m,
      .around = region ? std::optional(region->around) : std::nullopt,
  });
}

ClearanceField::~ClearanceField() = default;
ClearanceField::ClearanceField(ClearanceField&&) noexcept = default;
ClearanceField& ClearanceField::operator=(ClearanceField&&) noexcept = default;

double ClearanceField::horizon_m() const { return grid_->horizon_m; }

bool ClearanceField::has_occupied() const { return grid_->plan.has_occupied(); }

// What the region left out is at least a horizon away from every point of `around`.
double ClearanceField::distance_bound_m(const Eigen::Vector2d& point_in_source,
                                        ObstacleKind kind) const {
  const double seen_m = std::max(0.0, grid_->horizon_m - grid_->beyond_around(point_in_source));
  return std::min(seen_m, grid_->plan.lower_bound_m(grid_->in_grid(point_in_source), kind));
}

std::optional<ClearanceField::Nearest> ClearanceField::nearest(const geometry::Rectangle& in_source,
                                                               double within_m,
                                                               ObstacleKind kind) const {
  const geometry::Rectangle rectangle = grid_->in_grid(in_source);
  grid_->check_inside(rectangle);
  const auto nearest = grid_->plan.nearest(rectangle, std::min(within_m, grid_->horizon_m), kind);
  if (!nearest) return std::nullopt;
  return Nearest{nearest->distance_m, grid_->box_of(nearest->cell)};
}

double ClearanceField::unknown_share(const geometry::Rectangle& in_source) const {
  const geometry::Rectangle rectangle = grid_->in_grid(in_source);
  if (grid_->plan.lower_bound_m(rectangle.centre, ObstacleKind::unknown) > rectangle.radius_m()) {
    return 0.0;
  }
  const double cell_m = grid_->plan.cell_m();
  const auto cell = [&](double at_m) {
    return static_cast<std::int64_t>(std::floor(at_m / cell_m));
  };
  const Eigen::Vector2d least = rectangle.centre - half_extent_m(rectangle);
  const Eigen::Vector2d most = rectangle.centre + half_extent_m(rectangle);
  double unknown_m2 = 0.0;
  for (std::int64_t y = cell(least.y()); y <= cell(most.y()); ++y) {
    for (std::int64_t x = cell(least.x()); x <= cell(most.x()); ++x) {
      const double unmeasured = 1.0 - grid_->plan.measured_share({x, y});
      if (unmeasured == 0.0) continue;
      unknown_m2 +=
          unmeasured * overlap_with_square_m2(rectangle, grid_->plan.centre({x, y}), 0.5 * cell_m);
    }
  }
  return std::min(1.0, unknown_m2 / (4.0 * rectangle.half_length_m * rectangle.half_width_m));
}

}  // namespace roadbed::map
