#include "roadbed/map/occupancy/outputs/occupancy_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline occupancy::inline outputs {
namespace {

constexpr double kMostSquares = 1e8;

bool is_between(const OccupancyCell& cell, const GridHeights& heights) {
  const double half_m = 0.5 * cell.size_m;
  return cell.centre_in_source.z() + half_m > heights.from_m &&
         cell.centre_in_source.z() - half_m < heights.to_m;
}

// Where a cell begins, in squares from a corner.
Eigen::Array2i place_of(const OccupancyCell& cell, const OccupancyGrid& grid) {
  const Eigen::Vector2d begin = cell.centre_in_source.head<2>().array() - 0.5 * cell.size_m;
  return ((begin - grid.corner_in_source) / grid.resolution_m).array().round().cast<int>();
}

OccupancyGrid empty_grid(const std::vector<OccupancyCell>& cells, double resolution_m,
                         const std::string& name) {
  Eigen::Vector2d least = cells.front().centre_in_source.head<2>(), most = least;
  for (const OccupancyCell& cell : cells) {
    const Eigen::Vector2d centre = cell.centre_in_source.head<2>();
    least = least.cwiseMin((centre.array() - 0.5 * cell.size_m).matrix());
    most = most.cwiseMax((centre.array() + 0.5 * cell.size_m).matrix());
  }
  const Eigen::Vector2d size = ((most - least) / resolution_m).array().round();
  if (!(size.x() * size.y() <= kMostSquares)) {
    throw InputError({.file = name,
                      .found = fmt::format("{:.0f} by {:.0f} cells", size.x(), size.y()),
                      .needed = fmt::format("at most {:.0f} in all", kMostSquares),
                      .remedy = "build it with a coarser --resolution, or of a part"});
  }
  OccupancyGrid grid{.resolution_m = resolution_m,
                     .corner_in_source = least,
                     .columns = static_cast<std::size_t>(size.x()),
                     .rows = static_cast<std::size_t>(size.y()),
                     .squares = {}};
  grid.squares.assign(grid.columns * grid.rows, CellState::unknown);
  return grid;
}

}  // namespace

OccupancyGrid grid_from_above(const OccupancySource& occupancy, const GridHeights& heights,
                              const std::string& name) {
  std::vector<OccupancyCell> cells = occupancy.cells();
  std::erase_if(cells, [&](const OccupancyCell& cell) { return !is_between(cell, heights); });
  if (cells.empty()) {
    throw InputError({.file = name,
                      .found = "no cell between the heights",
                      .needed = "at least one",
                      .remedy = "give other heights; see: roadbed occupancy info"});
  }
  OccupancyGrid grid = empty_grid(cells, occupancy.resolution_m(), name);
  for (const OccupancyCell& cell : cells) {
    const Eigen::Array2i place = place_of(cell, grid);
    const auto side =
        static_cast<std::size_t>(std::max(1L, std::lround(cell.size_m / grid.resolution_m)));
    const auto first_column = static_cast<std::size_t>(place.x()),
               first_row = static_cast<std::size_t>(place.y());
    for (std::size_t row = first_row; row < first_row + side; ++row) {
      for (std::size_t column = first_column; column < first_column + side; ++column) {
        CellState& square = grid.squares[row * grid.columns + column];
        square = std::max(square, cell.state);  // unknown, free, occupied
      }
    }
  }
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
