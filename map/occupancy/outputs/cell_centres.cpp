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
void append_number(Number number, std::string& bytes) {
  static_assert(std::endian::native == std::endian::little);
  bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

std::string records(const std::vector<Eigen::Vector3d>& points,
                    const std::vector<Eigen::Vector3f>& normals, bool as_floats) {
  std::string bytes;
  bytes.reserve(
      points.size() * 3 *
      ((as_floats ? sizeof(float) : sizeof(double)) + (normals.empty() ? 0 : sizeof(float))));
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const double value : points[i]) {
      if (as_floats) {
        append_number(static_cast<float>(value), bytes);
      } else {
        append_number(value, bytes);
      }
    }
    if (normals.empty()) continue;
    for (const float value : normals[i]) append_number(value, bytes);
  }
  return bytes;
}

}  // namespace

std::vector<Eigen::Vector3d> occupied_centres(const OccupancySource& occupancy,
                                              const std::string& name) {
  const double resolution_m = occupancy.resolution_m();
  std::size_t count = 0;
  occupancy.for_each_cell([&](const OccupancyCell& leaf) {
    if (leaf.state != CellState::occupied) return;
    const auto along = static_cast<std::size_t>(cells_along(leaf, resolution_m));
    count += along * along * along;
    check_count(count, name);
  });
  std::vector<Eigen::Vector3d> points;
  points.reserve(count);
  occupancy.for_each_cell([&](const OccupancyCell& leaf) {
    if (leaf.state == CellState::occupied) append_leaf(leaf, resolution_m, points);
  });
  return points;
}

bool fit_in_floats(const std::vector<Eigen::Vector3d>& points) {
  return std::ranges::all_of(points, [](const Eigen::Vector3d& point) {
    return point.cwiseAbs().maxCoeff() <= kFloatReach_m;
  });
}

std::string points_as_pcd(const std::vector<Eigen::Vector3d>& points,
                          const std::vector<Eigen::Vector3f>& normals) {
  const bool as_floats = fit_in_floats(points), has_normals = !normals.empty();
  const int size = as_floats ? 4 : 8;
  return fmt::format(
             "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z{2}\n"
             "SIZE {0} {0} {0}{3}\nTYPE F F F{4}\nCOUNT 1 1 1{5}\nWIDTH {1}\nHEIGHT 1\n"
             "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {1}\nDATA binary\n",
             size, points.size(), has_normals ? " normal_x normal_y normal_z" : "",
             has_normals ? " 4 4 4" : "", has_normals ? " F F F" : "",
             has_normals ? " 1 1 1" : "") +
         records(points, normals, as_floats);
}

std::string points_as_ply(const std::vector<Eigen::Vector3d>& points,
                          const std::vector<Eigen::Vector3f>& normals) {
  const bool as_floats = fit_in_floats(points);
  const char* type = as_floats ? "float" : "double";
  const char* of_normals =
      normals.empty() ? "" : "property float nx\nproperty float ny\nproperty float nz\n";
  return fmt::format(
             "ply\nformat binary_little_endian 1.0\nelement vertex {1}\nproperty {0} x\n"
             "property {0} y\nproperty {0} z\n{2}end_header\n",
             type, points.size(), of_normals) +
         records(points, normals, as_floats);
}

}  // namespace roadbed::map::occupancy::outputs
