#include "roadbed/map/occupancy/clearance/clearance_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clearance/grid_tiles.h"
#include "roadbed/map/occupancy/clearance/height_band_slicer.h"
#include "roadbed/map/occupancy/clearance/plan_grid.h"
#include "roadbed/map/occupancy/clearance/rectangle_cover.h"

namespace roadbed::map::inline occupancy::inline clearance {
namespace {

constexpr double kHorizon_m = 1000.0;
constexpr double kHorizonInTiles_m = 50.0, kBodyRadius_m = 20.0;  // without a region
constexpr double kRounding_m = 1e-6;
constexpr double kTouch_m = 1e-6;  // cells that overlap the band by less only touch it

void check(const HeightBand& band) {
  constexpr double highest_m = 1e6;
  if (!(band.to_m - band.from_m > 2.0 * kTouch_m) || !(band.from_m > -highest_m) ||
      !(band.to_m < highest_m)) {
    throw std::invalid_argument(
        fmt::format("ClearanceField: band from {} m to {} m is empty", band.from_m, band.to_m));
  }
}

bool is_small(const CellRange& range) {
  constexpr std::int64_t longest = 65536;
  return range.width() <= longest && range.height() <= longest &&
         range.count() <= ClearanceField::kMostCells;
}

void check_size(const CellRange& range, std::int64_t layers, double cell_m) {
  constexpr auto most = static_cast<std::int64_t>(ClearanceField::kMostCells);
  constexpr std::int64_t longest = 65536;
  if (is_small(range) && layers < longest) return;
  throw InputError(
      {.file = "occupancy",
       .element = "extent",
       .found = fmt::format("{} × {} cells of {} m in {} layers", range.width(), range.height(),
                            cell_m, layers),
       .needed = fmt::format("at most {} cells, and {} a side", most, longest),
       .remedy = "cut the occupancy, ask for less clearance, or take a coarser resolution"});
}

CellRange range_of(const std::vector<Slab>& slabs) {
  CellRange range;
  for (const Slab& slab : slabs) range = range.joined(slab.cells);
  return range;
}

}  // namespace

/// One grid where that is small enough, else tiles of it.
struct ClearanceField::Grid {
  HeightBandSlicer slicer;
  double horizon_m = kHorizon_m, body_radius_m = 0.0;  // the latter of a region, or of tiles
  std::optional<Box2> around = std::nullopt;
  std::shared_ptr<const PlanGrid> whole = nullptr;
  std::unique_ptr<const GridTiles> tiles = nullptr;

  // What is more than a horizon away from a region does not matter; two cells more cover the way
  // from points and boxes to the centres of their cells.
  void make(const FieldRegion& region) {
    horizon_m = std::min(region.horizon_m, kHorizon_m);
    body_radius_m = region.body_radius_m;
    around = region.around;
    const CellRange held = slicer.range(region.around, slicer.cell_m());
    const auto margin = static_cast<std::int64_t>(std::ceil(horizon_m / slicer.cell_m())) + 3;
    const CellRange seen = held.grown(margin);
    if (region.tile_m == 0.0 && is_small(seen) &&
        seen.count() <= std::min(kMostOfOneGrid, region.most_cells)) {
      whole = grid_of({held, seen, false});
    } else {
      make_tiles(region.tile_m, region.most_cells);
    }
  }

  void make_whole() {
    const std::vector<Slab> slabs = slicer.slabs();
    const CellRange all = range_of(slabs);
    if (!is_small(all)) {
      horizon_m = kHorizonInTiles_m;
      body_radius_m = kBodyRadius_m;
      return make_tiles(0.0, kMostCells);
    }
    whole = grid_of({all, all, true}, [&](const CellRange& range, const UseSlab& use) {
      for (const Slab& slab : slabs) {
        if (!slab.cells.cut(range).empty()) use(slab);
      }
    });
  }

  // A box within the horizon of a body whose centre lies in a tile has its centre at most horizon,
  // body's radius and half a box's diagonal away from the tile.
  void make_tiles(double tile_m, std::size_t most_cells) {
    most_cells = std::min(most_cells, kMostCells);
    const double cell_m = slicer.cell_m();
    const auto margin =
        static_cast<std::int64_t>(std::ceil((horizon_m + body_radius_m) / cell_m)) + 3;
    constexpr std::int64_t longest = 10'000;  // of a side with both margins: kMostCells in all
    const auto of_two = static_cast<std::int64_t>(std::sqrt(static_cast<double>(most_cells) / 2.0));
    const std::int64_t least = std::clamp<std::int64_t>(longest - 2 * margin, 1, margin);
    const std::int64_t usual = std::clamp(of_two - 2 * margin, least, std::max(least, 2 * margin));
    const std::int64_t side =
        tile_m > 0.0 ? static_cast<std::int64_t>(std::ceil(tile_m / cell_m)) : usual;
    const CellRange first = CellRange{0, 0, side, side}.grown(margin);
    check_size(first, slicer.layers(), cell_m);
    tiles = std::make_unique<const GridTiles>(
        side, std::max<std::size_t>(1, most_cells / first.count()), [this, margin](CellRange tile) {
          return grid_of({tile, tile.grown(margin), false});
        });
  }

  std::shared_ptr<const PlanGrid> grid_of(const GridExtent& extent) const {
    return grid_of(extent, [this](const CellRange& range, const UseSlab& use) {
      slicer.for_each_slab_in(range, use);
    });
  }

  std::shared_ptr<const PlanGrid> grid_of(const GridExtent& extent, const SlabsIn& slabs_in) const {
    check_size(extent.seen, slicer.layers(), slicer.cell_m());
    return std::make_shared<const PlanGrid>(slabs_in, extent, slicer.layers(), slicer.cell_m());
  }

  // What a grid around the point says.
  template <typename Question>
  auto ask(const Eigen::Vector2d& point, const Question& question) const {
    if (whole) return question(*whole);
    const std::shared_ptr<const PlanGrid> tile = tiles->at(
        whole_below(point.x() / slicer.cell_m()), whole_below(point.y() / slicer.cell_m()));
    return question(*tile);
  }

  Eigen::Vector2d in_grid(const Eigen::Vector2d& in_source) const {
    return in_source - slicer.origin_in_source();
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
    return inside == in_source ? 0.0 : (in_source - inside).norm();
  }

  bool is_too_large(const geometry::Rectangle& rectangle) const {
    return (around || tiles) && rectangle.radius_m() > body_radius_m + kRounding_m;
  }

  bool is_inside(const geometry::Rectangle& rectangle) const {
    if (!around) return true;
    const Eigen::Vector2d half = half_extent_m(rectangle);
    const Eigen::Vector2d centre = rectangle.centre + slicer.origin_in_source();
    return beyond_around(centre - half) <= kRounding_m &&
           beyond_around(centre + half) <= kRounding_m;
  }

  void check_inside(const geometry::Rectangle& rectangle) const {
    if (tiles && is_too_large(rectangle)) {
      throw std::invalid_argument(fmt::format(
          "ClearanceField: the body's radius is {} m, the field's tiles are made for {} m",
          rectangle.radius_m(), body_radius_m));
    }
    if (is_inside(rectangle)) return;
    const Eigen::Vector2d half = half_extent_m(rectangle);
    const Eigen::Vector2d centre = rectangle.centre + slicer.origin_in_source();
    const Eigen::Vector2d least = centre - half, most = centre + half;
    throw std::invalid_argument(fmt::format(
        "ClearanceField: the vehicle (x {} to {}, y {} to {}) leaves the region of the field",
        least.x(), most.x(), least.y(), most.y()));
  }

  Box2 box_of(const NearCell& cell) const {
    const double cell_m = slicer.cell_m();
    const Eigen::Array2d middle =
        slicer.origin_in_source() + cell_m * Eigen::Vector2d(static_cast<double>(cell.x) + 0.5,
                                                             static_cast<double>(cell.y) + 0.5);
    return {middle - 0.5 * cell_m, middle + 0.5 * cell_m};
  }
};

ClearanceField::ClearanceField(const OccupancySource& occupancy, const HeightBand& band,
                               const std::optional<FieldRegion>& region) {
  check(band);
  if (band.ground && !region) {
    throw std::invalid_argument("ClearanceField: a band over a ground needs a region");
  }
  grid_.reset(new Grid{.slicer = HeightBandSlicer(occupancy, band)});
  if (region) {
    grid_->make(*region);
  } else {
    grid_->make_whole();
  }
}

ClearanceField::~ClearanceField() = default;
ClearanceField::ClearanceField(ClearanceField&&) noexcept = default;
ClearanceField& ClearanceField::operator=(ClearanceField&&) noexcept = default;

double ClearanceField::horizon_m() const { return grid_->horizon_m; }

// What the region left out is at least a horizon away from every point of `around`.
double ClearanceField::distance_bound_m(const Eigen::Vector2d& point_in_source,
                                        ObstacleKind kind) const {
  const double seen_m = std::max(0.0, grid_->horizon_m - grid_->beyond_around(point_in_source));
  const Eigen::Vector2d point = grid_->in_grid(point_in_source);
  return grid_->ask(point, [&](const PlanGrid& grid) {
    return std::min(seen_m, grid.lower_bound_m(point, kind));
  });
}

bool ClearanceField::is_made_for(const geometry::Rectangle& in_source) const {
  const geometry::Rectangle rectangle = grid_->in_grid(in_source);
  return !grid_->is_too_large(rectangle) && grid_->is_inside(rectangle);
}

std::optional<ClearanceField::Nearest> ClearanceField::nearest(const geometry::Rectangle& in_source,
                                                               double within_m,
                                                               ObstacleKind kind) const {
  const geometry::Rectangle rectangle = grid_->in_grid(in_source);
  grid_->check_inside(rectangle);
  const auto nearest = grid_->ask(rectangle.centre, [&](const PlanGrid& grid) {
    return grid.nearest(rectangle, std::min(within_m, grid_->horizon_m), kind);
  });
  if (!nearest) return std::nullopt;
  return Nearest{nearest->distance_m, grid_->box_of(*nearest)};
}

std::optional<ClearanceField::Nearest> ClearanceField::nearest_measured(
    const geometry::Rectangle& in_source, double within_m) const {
  const geometry::Rectangle rectangle = grid_->in_grid(in_source);
  grid_->check_inside(rectangle);
  const auto nearest = grid_->ask(rectangle.centre, [&](const PlanGrid& grid) {
    return grid.nearest_measured(rectangle, std::min(within_m, grid_->horizon_m));
  });
  if (!nearest) return std::nullopt;
  return Nearest{nearest->distance_m, grid_->box_of(*nearest)};
}

std::vector<Box2> ClearanceField::boxes_at(const geometry::Rectangle& in_source,
                                           ObstacleKind kind) const {
  const geometry::Rectangle rectangle = grid_->in_grid(in_source);
  grid_->check_inside(rectangle);
  const std::vector<NearCell> cells = grid_->ask(
      rectangle.centre, [&](const PlanGrid& grid) { return grid.cells_at(rectangle, kind); });
  std::vector<Box2> boxes;
  for (const NearCell& cell : cells) boxes.push_back(grid_->box_of(cell));
  return boxes;
}

double ClearanceField::unknown_fraction(const geometry::Rectangle& in_source) const {
  const geometry::Rectangle rectangle = grid_->in_grid(in_source);
  grid_->check_inside(rectangle);
  return grid_->ask(rectangle.centre,
                    [&](const PlanGrid& grid) { return grid.unknown_fraction(rectangle); });
}

}  // namespace roadbed::map::occupancy::clearance
