#include "roadbed/map/occupancy/outputs/grid_raster.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clearance/distance_transform.h"

namespace roadbed::map::inline occupancy::inline outputs {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

std::vector<float> occupied_band(const OccupancyGrid& grid) {
  std::vector<float> values;
  values.reserve(grid.squares.size());
  for (const CellState state : grid.squares) {
    values.push_back(state == CellState::unknown ? kNothing
                                                 : (state == CellState::occupied ? 1.0f : 0.0f));
  }
  return values;
}

struct HeightBands {
  std::vector<float> lowest_m, highest_m;
};

// fmin and fmax take NaN for what is not there yet.
HeightBands height_bands(const OccupancySource& occupancy, const GridHeights& heights,
                         const OccupancyGrid& grid) {
  HeightBands bands;
  for (auto* band : {&bands.lowest_m, &bands.highest_m})
    band->assign(grid.squares.size(), kNothing);
  const CellGrid cells(occupancy);
  for_each_part(occupancy, heights, [&](const CellBox& part, CellState state) {
    if (state != CellState::occupied) return;
    const Box3 place = cells.box_in_source(part);
    const auto bottom_m = static_cast<float>(place.min_in_source.z()),
               top_m = static_cast<float>(place.max_in_source.z());
    grid.for_each_square(part, [&](std::size_t square) {
      bands.lowest_m[square] = std::fmin(bands.lowest_m[square], bottom_m);
      bands.highest_m[square] = std::fmax(bands.highest_m[square], top_m);
    });
  });
  return bands;
}

// A square of a raster takes some 25 bytes while it is made, and two cells can be far apart.
void check_sparse(const OccupancySource& occupancy, const GridHeights& heights,
                  const OccupancyGrid& grid, const std::string& name) {
  constexpr std::size_t enough = 8'000'000, for_each = 100;
  std::size_t parts = 0;
  for_each_part(occupancy, heights, [&](const CellBox&, CellState) { ++parts; });
  if (grid.squares.size() <= enough + for_each * parts) return;
  throw InputError(
      {.file = name,
       .found = fmt::format("{} by {} squares for {} cells", grid.columns, grid.rows, parts),
       .needed = fmt::format("at most {}, and {} for each cell", enough, for_each),
       .remedy = "take a part with roadbed occupancy crop, or write .pgm"});
}

void check_sides(const OccupancyGrid& grid, const std::string& name) {
  constexpr std::size_t most = 65536;
  if (grid.columns <= most && grid.rows <= most) return;
  throw InputError({.file = name,
                    .found = fmt::format("{} by {} cells", grid.columns, grid.rows),
                    .needed = fmt::format("at most {} a side", most),
                    .remedy = "take a part with roadbed occupancy crop"});
}

std::vector<float> clearance_band(const OccupancyGrid& grid) {
  std::vector<std::uint8_t> set;
  set.reserve(grid.squares.size());
  for (const CellState state : grid.squares) set.push_back(state == CellState::occupied);
  std::vector<float> values = distances_to_set(set, grid.columns, grid.rows);
  const auto cell_m = static_cast<float>(grid.resolution_m);
  for (float& value : values) value = std::isfinite(value) ? value * cell_m : kNothing;
  return values;
}

}  // namespace

Raster raster_from_above(const OccupancySource& occupancy, const GridHeights& heights,
                         const std::string& name) {
  const OccupancyGrid grid = grid_from_above(occupancy, heights, name);
  check_sides(grid, name);
  check_sparse(occupancy, heights, grid, name);
  HeightBands bands = height_bands(occupancy, heights, grid);
  return {.cell_m = grid.resolution_m,
          .corner = grid.corner_in_source,
          .columns = grid.columns,
          .rows = grid.rows,
          .bands = {{"occupied", occupied_band(grid)},
                    {"lowest_m", std::move(bands.lowest_m)},
                    {"highest_m", std::move(bands.highest_m)},
                    {"clearance_m", clearance_band(grid)}}};
}

}  // namespace roadbed::map::occupancy::outputs
