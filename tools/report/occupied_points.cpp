#include "roadbed/tools/report/occupied_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace roadbed::tools::inline report {
namespace {

using Eigen::Vector3d;

std::vector<map::OccupancyCell> occupied_cells(const map::OccupancySource& occupancy,
                                               const Eigen::AlignedBox2d& box) {
  constexpr double any_height_m = 1e6;
  std::vector<map::OccupancyCell> cells =
      occupancy.cells_in({{box.min().x(), box.min().y(), -any_height_m},
                          {box.max().x(), box.max().y(), any_height_m}});
  std::erase_if(cells, [&](const map::OccupancyCell& cell) {
    return cell.state != map::CellState::occupied ||
           !box.contains(Eigen::Vector2d(cell.centre_in_source.head<2>()));
  });
  return cells;
}

/// Cells in cells of a size at least, each once.
std::vector<map::OccupancyCell> coarser(const std::vector<map::OccupancyCell>& cells, double size_m,
                                        const Vector3d& origin) {
  std::vector<map::OccupancyCell> coarse;
  std::set<std::array<long long, 3>> seen;
  for (map::OccupancyCell cell : cells) {
    if (cell.size_m < size_m) {
      const Vector3d steps = ((cell.centre_in_source - origin) / size_m).array().floor();
      const std::array<long long, 3> key{std::llround(steps.x()), std::llround(steps.y()),
                                         std::llround(steps.z())};
      if (!seen.insert(key).second) continue;
      cell.centre_in_source = origin + ((steps.array() + 0.5) * size_m).matrix();
      cell.size_m = size_m;
    }
    coarse.push_back(cell);
  }
  return coarse;
}

}  // namespace

std::vector<SizedPoint> occupied_points(const map::OccupancySource& occupancy,
                                        const Eigen::AlignedBox2d& box_in_source,
                                        const Eigen::Vector2d& origin_in_source, std::size_t most) {
  std::vector<map::OccupancyCell> cells = occupied_cells(occupancy, box_in_source);
  for (double size_m = 2.0 * occupancy.resolution_m(); cells.size() > most; size_m *= 2.0) {
    cells = coarser(cells, size_m, occupancy.origin_in_source());
  }
  const Vector3d origin(origin_in_source.x(), origin_in_source.y(), 0.0);
  std::vector<SizedPoint> points;
  for (const map::OccupancyCell& cell : cells) {
    points.push_back(
        {(cell.centre_in_source - origin).cast<float>(), static_cast<float>(cell.size_m)});
  }
  return points;
}

}  // namespace roadbed::tools::report
