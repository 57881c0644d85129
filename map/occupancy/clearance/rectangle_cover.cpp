#include "roadbed/map/occupancy/clearance/rectangle_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace roadbed::map::inline occupancy::inline clearance {

Eigen::Vector2d half_extent_m(const geometry::Rectangle& rectangle) {
  const Eigen::Vector2d left(-rectangle.axis.y(), rectangle.axis.x());
  return rectangle.half_length_m * rectangle.axis.cwiseAbs() +
         rectangle.half_width_m * left.cwiseAbs();
}

// A column more on the right takes what lies beyond the last cell.
CellRange RectangleCover::cells_touched(const geometry::Rectangle& rectangle, double cell_m) {
  const Eigen::Vector2d half = half_extent_m(rectangle);
  const Eigen::Vector2d least = (rectangle.centre - half) / cell_m,
                        most = (rectangle.centre + half) / cell_m;
  return {whole_below(least.x()), whole_below(least.y()), whole_below(most.x()) + 3,
          whole_below(most.y()) + 1};
}

RectangleCover::RectangleCover(const geometry::Rectangle& rectangle, double cell_m)
    : range_(cells_touched(rectangle, cell_m)) {
  fractions_.resize(range_.count() + 1);
  const std::array<Eigen::Vector2d, 4> corners = rectangle.corners();
  const Eigen::Vector2d first(static_cast<double>(range_.from_x),
                              static_cast<double>(range_.from_y));
  for (std::size_t i = 0; i < 4; ++i) {
    add_side(corners[i] / cell_m - first, corners[(i + 1) % 4] / cell_m - first);
  }
  for (std::int64_t y = range_.from_y; y < range_.to_y; ++y) {
    double sum = 0.0;
    for (std::size_t i = range_.index(range_.from_x, y); i < range_.index(range_.to_x, y); ++i) {
      constexpr double rounding = 1e-12;  // of a cell that is not covered at all
      sum += fractions_[i];
      fractions_[i] = sum < rounding ? 0.0 : std::min(sum, 1.0);
    }
  }
}

void RectangleCover::add_side(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const bool is_up = from.y() < to.y();
  const Eigen::Vector2d &low = is_up ? from : to, &high = is_up ? to : from;
  if (!(low.y() < high.y())) return;
  const double slope = (high.x() - low.x()) / (high.y() - low.y());
  const auto last = static_cast<double>(range_.height() - 1);
  for (double row = std::clamp(std::floor(low.y()), 0.0, last); row <= last && row < high.y();
       row += 1.0) {
    const double from_y = std::max(row, low.y()), to_y = std::min(row + 1.0, high.y());
    // The inside of a ring that runs counter-clockwise is to the right of sides that go down.
    const double rise = is_up ? from_y - to_y : to_y - from_y;
    add_in_row(static_cast<std::size_t>(row), low.x() + slope * (from_y - low.y()),
               low.x() + slope * (to_y - low.y()), rise);
  }
}

// Of a side within a row: in each cell the height that it gained so far, less its mean way inside.
void RectangleCover::add_in_row(std::size_t row, double from_x, double to_x, double rise) {
  const auto width = static_cast<double>(range_.width());
  const double left = std::clamp(std::min(from_x, to_x), 0.0, width - 2.0);
  const double right = std::clamp(std::max(from_x, to_x), left, width - 2.0);
  double* cells = &fractions_[row * static_cast<std::size_t>(range_.width())];
  const double per_cell = right > left ? rise / (right - left) : 0.0;
  for (double cell = std::floor(left);; cell += 1.0) {
    const double enters = std::max(left, cell), leaves = std::min(right, cell + 1.0);
    const double gained = right > left ? per_cell * (leaves - enters) : rise;
    const double beside =
        0.5 * (enters + leaves) - cell;  // left of the side, mean fraction of a cell
    const auto i = static_cast<std::size_t>(cell);
    cells[i] += gained * (1.0 - beside);
    cells[i + 1] += gained * beside;
    if (cell + 1.0 >= right) return;
  }
}

}  // namespace roadbed::map::occupancy::clearance
