#include "roadbed/map/occupancy/outputs/cell_centres.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline occupancy::inline outputs {
namespace {

constexpr double kFloatReach_m = 4096.0;
constexpr std::size_t kMostPoints = 100'000'000;

// Cells of the finest size along a leaf's side.
long cells_along(const OccupancyCell& leaf, double resolution_m) {
  return std::max(1L, std::lround(leaf.size_m / resolution_m));
}

void check_count(std::size_t count, const std::string& name) {
  if (count <= kMostPoints) return;
  throw InputError({.file = name,
                    .found = fmt::format("more than {} occupied cells", kMostPoints),
                    .needed = "fewer",
                    .remedy = "build it with a coarser --resolution"});
}

void append_leaf(const OccupancyCell& leaf, double resolution_m,
                 std::vector<Eigen::Vector3d>& points) {
  const long count = cells_along(leaf, resolution_m);
  const Eigen::Vector3d first =
      leaf.centre_in_source.array() - 0.5 * static_cast<double>(count - 1) * resolution_m;
  for (long x = 0; x < count; ++x) {
    for (long y = 0; y < count; ++y) {
      for (long z = 0; z < count; ++z) {
        points.push_back(first + resolution_m * Eigen::Vector3d(static_cast<double>(x),
                                                                static_cast<double>(y),
                                                                static_cast<double>(z)));
      }
    }
  }
}

template <typename Number>
std::string coordinates(const std::vector<Eigen::Vector3d>& points) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes;
  bytes.reserve(points.size() * 3 * sizeof(Number));
  for (const Eigen::Vector3d& point : points) {
    for (const double value : point) {
      const auto number = static_cast<Number>(value);
      bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
    }
  }
  return bytes;
}

std::string coordinates(const std::vector<Eigen::Vector3d>& points, bool as_floats) {
  return as_floats ? coordinates<float>(points) : coordinates<double>(points);
}

}  // namespace

std::vector<Eigen::Vector3d> occupied_centres(const OccupancySource& occupancy,
                                              const std::string& name) {
  const double resolution_m = occupancy.resolution_m();
  const std::vector<OccupancyCell> leaves = occupancy.cells();
  std::size_t count = 0;
  for (const OccupancyCell& leaf : leaves) {
    if (leaf.state != CellState::occupied) continue;
    const auto along = static_cast<std::size_t>(cells_along(leaf, resolution_m));
    count += along * along * along;
    check_count(count, name);
  }
  std::vector<Eigen::Vector3d> points;
  points.reserve(count);
  for (const OccupancyCell& leaf : leaves) {
    if (leaf.state == CellState::occupied) append_leaf(leaf, resolution_m, points);
  }
  return points;
}

bool fit_in_floats(const std::vector<Eigen::Vector3d>& points) {
  return std::ranges::all_of(points, [](const Eigen::Vector3d& point) {
    return point.cwiseAbs().maxCoeff() <= kFloatReach_m;
  });
}

std::string points_as_pcd(const std::vector<Eigen::Vector3d>& points) {
  const bool as_floats = fit_in_floats(points);
  const int size = as_floats ? 4 : 8;
  return fmt::format(
             "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\n"
             "SIZE {0} {0} {0}\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {1}\nHEIGHT 1\n"
             "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {1}\nDATA binary\n",
             size, points.size()) +
         coordinates(points, as_floats);
}

std::string points_as_ply(const std::vector<Eigen::Vector3d>& points) {
  const bool as_floats = fit_in_floats(points);
  const char* type = as_floats ? "float" : "double";
  return fmt::format(
             "ply\nformat binary_little_endian 1.0\nelement vertex {1}\nproperty {0} x\n"
             "property {0} y\nproperty {0} z\nend_header\n",
             type, points.size()) +
         coordinates(points, as_floats);
}

}  // namespace roadbed::map::occupancy::outputs
