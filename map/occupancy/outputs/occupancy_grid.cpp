#include "roadbed/map/occupancy/outputs/occupancy_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline occupancy::inline outputs {
namespace {

constexpr double kMostSquares = 1e8;

OccupancyGrid empty_grid(const CellBox& box, const CellGrid& cells, double resolution_m,
                         const std::string& name) {
  const std::int64_t columns = box.to[0] - box.from[0], rows = box.to[1] - box.from[1];
  if (!(static_cast<double>(columns) * static_cast<double>(rows) <= kMostSquares)) {
    throw InputError({.file = name,
                      .found = fmt::format("{} by {} cells", columns, rows),
                      .needed = fmt::format("at most {:.0f} in all", kMostSquares),
                      .remedy = "take a part with roadbed occupancy crop"});
  }
  OccupancyGrid grid{.resolution_m = resolution_m,
                     .corner_in_source = cells.corner_in_source(box.from).head<2>(),
                     .corner = box.from,
                     .columns = static_cast<std::size_t>(columns),
                     .rows = static_cast<std::size_t>(rows),
                     .squares = {}};
  grid.squares.assign(grid.columns * grid.rows, CellState::unknown);
  return grid;
}

}  // namespace

void for_each_part(const OccupancySource& occupancy, const GridHeights& heights,
                   const std::function<void(const CellBox&, CellState)>& use) {
  constexpr double anywhere = std::numeric_limits<double>::infinity();
  const CellGrid grid(occupancy);
  const CellBox between = grid.cells_of(
      Box3{{-anywhere, -anywhere, heights.from_m}, {anywhere, anywhere, heights.to_m}});
  occupancy.for_each_cell([&](const OccupancyCell& leaf) {
    const CellBox cells = grid.cells_of(leaf).cut(between);
    if (!cells.empty()) use(cells, leaf.state);
  });
}

OccupancyGrid grid_from_above(const OccupancySource& occupancy, const GridHeights& heights,
                              const std::string& name) {
  const CellGrid cells(occupancy);
  CellBox box;
  for_each_part(occupancy, heights,
                [&](const CellBox& part, CellState) { box = box.joined(part); });
  if (box.empty()) {
    throw InputError({.file = name,
                      .found = "no cell between the heights",
                      .needed = "at least one",
                      .remedy = "give other heights; see: roadbed occupancy info"});
  }
  OccupancyGrid grid = empty_grid(box, cells, occupancy.resolution_m(), name);
  for_each_part(occupancy, heights, [&](const CellBox& part, CellState state) {
    grid.for_each_square(part, [&](std::size_t square) {
      grid.squares[square] = std::max(grid.squares[square], state);  // unknown, free, occupied
    });
  });
  return grid;
}

std::string grid_as_pgm(const OccupancyGrid& grid) {
  std::string image = fmt::format("P5\n{} {}\n255\n", grid.columns, grid.rows);
  image.reserve(image.size() + grid.squares.size());
  for (std::size_t row = grid.rows; row-- > 0;) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const CellState state = grid.at(column, row);
      const int grey = state == CellState::occupied ? 0 : state == CellState::free ? 254 : 205;
      image += static_cast<char>(grey);
    }
  }
  return image;
}

std::string grid_yaml(const OccupancyGrid& grid, const std::string& image) {
  return fmt::format(
      "image: {}\nmode: trinary\nresolution: {}\norigin: [{}, {}, 0]\nnegate: 0\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
      image, grid.resolution_m, grid.corner_in_source.x(), grid.corner_in_source.y());
}

}  // namespace roadbed::map::occupancy::outputs
