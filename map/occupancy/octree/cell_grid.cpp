#include "roadbed/map/occupancy/octree/cell_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline occupancy::inline octree {
namespace {

constexpr double kRounding = 1e-6;    // of a cell
constexpr double kFarthest = 0x1p50;  // cells, so that sums of two do not overflow

std::int64_t whole(double cells) { return std::llround(std::clamp(cells, -kFarthest, kFarthest)); }

}  // namespace

CellBox CellBox::cut(const CellBox& other) const {
  CellBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.from[axis] = std::max(from[axis], other.from[axis]);
    box.to[axis] = std::min(to[axis], other.to[axis]);
  }
  return box;
}

CellBox CellBox::joined(const CellBox& other) const {
  if (empty()) return other;
  if (other.empty()) return *this;
  CellBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.from[axis] = std::min(from[axis], other.from[axis]);
    box.to[axis] = std::max(to[axis], other.to[axis]);
  }
  return box;
}

CellBox CellGrid::cells_of(const OccupancyCell& leaf) const {
  const std::int64_t side = whole(leaf.size_m / resolution_m_);
  CellBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double least_m =
        leaf.centre_in_source[axis] - 0.5 * leaf.size_m - origin_in_source_[axis];
    box.from[i] = whole(least_m / resolution_m_);
    box.to[i] = box.from[i] + side;
  }
  return box;
}

CellBox CellGrid::cells_of(const Box3& box) const {
  CellBox cells;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const auto borders = [&](double at_m) {
      return (at_m - origin_in_source_[axis]) / resolution_m_;
    };
    cells.from[i] = whole(std::floor(borders(box.min_in_source[axis]) + kRounding));
    cells.to[i] = whole(std::ceil(borders(box.max_in_source[axis]) - kRounding));
  }
  return cells;
}

CellBox CellGrid::cells_with_middle_in(const Box3& box) const {
  CellBox cells;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const auto middles_before = [&](double at_m) {
      return (at_m - origin_in_source_[axis]) / resolution_m_ - 0.5;
    };
    cells.from[i] = whole(std::ceil(middles_before(box.min_in_source[axis]) - kRounding));
    cells.to[i] = whole(std::floor(middles_before(box.max_in_source[axis]) + kRounding)) + 1;
  }
  return cells;
}

Eigen::Vector3d CellGrid::corner_in_source(const CellPlace& cell) const {
  const Eigen::Vector3d cells(static_cast<double>(cell[0]), static_cast<double>(cell[1]),
                              static_cast<double>(cell[2]));
  return origin_in_source_ + resolution_m_ * cells;
}

Box3 CellGrid::box_in_source(const CellBox& cells) const {
  return {corner_in_source(cells.from), corner_in_source(cells.to)};
}

void check_one_grid(const OccupancySource& occupancy, const std::string& name,
                    const OccupancySource& other, const std::string& other_name) {
  const auto refuse = [&](const std::string& found, const std::string& needed,
                          const std::string& remedy) {
    throw InputError({.file = other_name,
                      .found = found,
                      .needed = fmt::format("{} as {} has", needed, name),
                      .remedy = remedy});
  };
  if (occupancy.resolution_m() != other.resolution_m()) {
    refuse(fmt::format("cells of {} m", other.resolution_m()),
           fmt::format("cells of {} m", occupancy.resolution_m()),
           "build both from their clouds with the same --resolution");
  }
  if (occupancy.crs() != other.crs()) {
    refuse(fmt::format("the coordinate system \"{}\"", other.crs()),
           fmt::format("\"{}\"", occupancy.crs()), "build both from clouds in one system");
  }
  const Eigen::Vector3d apart =
      (other.origin_in_source() - occupancy.origin_in_source()) / occupancy.resolution_m();
  if ((apart - apart.array().round().matrix()).cwiseAbs().maxCoeff() > kRounding) {
    const Eigen::Vector3d &here = occupancy.origin_in_source(), &there = other.origin_in_source();
    refuse(fmt::format("the origin {} {} {}", there.x(), there.y(), there.z()),
           fmt::format("one that is whole cells away from {} {} {}", here.x(), here.y(), here.z()),
           "build both in one frame");
  }
}

}  // namespace roadbed::map::occupancy::octree
