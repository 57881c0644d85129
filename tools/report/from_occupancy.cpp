#include "roadbed/tools/report/surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace roadbed::tools::inline report {
namespace {

using map::Box2;

constexpr double kSame_m = 1e-6;  // far below any cell, far above the rounding of coordinates

// Micrometres: neighbours' edges are computed apart and must compare equal.
long long steps(double value_m) { return std::llround(value_m / kSame_m); }

// Joins neighbours of a sorted list along one axis (0: x, 1: y): those that have the same extent
// across it and touch or overlap along it.
std::vector<Box2> joined_along(std::vector<Box2> boxes, int axis) {
  const int across = 1 - axis;
  const auto key = [&](const Box2& box) {
    return std::array<long long, 4>{steps(box.min_in_source[across]),
                                    steps(box.max_in_source[across]),
                                    steps(box.min_in_source[axis]), steps(box.max_in_source[axis])};
  };
  std::ranges::sort(boxes, {}, key);
  std::vector<Box2> result;
  for (const Box2& box : boxes) {
    const bool touches = !result.empty() && key(result.back())[0] == key(box)[0] &&
                         key(result.back())[1] == key(box)[1] &&
                         key(result.back())[3] >= key(box)[2];
    if (!touches) {
      result.push_back(box);
    } else {
      double& end = result.back().max_in_source[axis];
      end = std::max(end, box.max_in_source[axis]);
    }
  }
  return result;
}

}  // namespace

std::vector<Box2> joined(std::vector<Box2> boxes) {
  return joined_along(joined_along(std::move(boxes), 0), 1);
}

std::vector<Box2> occupied_in(const map::OccupancySource& occupancy, const map::HeightBand& band,
                              const Eigen::AlignedBox2d& box_in_source) {
  std::vector<Box2> boxes;
  const Eigen::Vector2d &least = box_in_source.min(), &most = box_in_source.max();
  constexpr double any_height_m = 1e6;
  const map::Box3 box{{least.x(), least.y(), -any_height_m}, {most.x(), most.y(), any_height_m}};
  occupancy.for_each_in(box, [&](const map::OccupancyCell& cell) {
    const double half_m = 0.5 * cell.size_m, z_m = cell.centre_in_source.z();
    if (cell.state != map::CellState::occupied) return;
    const Eigen::Vector2d centre = cell.centre_in_source.head<2>();
    if (!band.holds(centre, z_m - half_m, 2.0 * half_m)) return;
    const Eigen::Vector2d corner(half_m, half_m);
    if (!box_in_source.intersects(Eigen::AlignedBox2d(centre - corner, centre + corner))) return;
    boxes.push_back({centre - corner, centre + corner});
  });
  return joined(std::move(boxes));
}

}  // namespace roadbed::tools::report
