#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/octree/cloud_measurements.h"

namespace roadbed::map::inline occupancy::inline octree {
namespace {

Eigen::Vector3d choose_origin(std::span<const PointCloud> clouds, double resolution_m) {
  Box3 all = bounds(clouds.front());
  for (const PointCloud& cloud : clouds.subspan(1)) {
    const Box3 box = bounds(cloud);
    all.min_in_source = all.min_in_source.cwiseMin(box.min_in_source);
    all.max_in_source = all.max_in_source.cwiseMax(box.max_in_source);
  }
  return tree_origin(all, resolution_m);
}

void check(std::span<const PointCloud> clouds, const OccupancyOptions& options) {
  if (!(options.resolution_m > 0.0) || !std::isfinite(options.resolution_m)) {
    throw std::invalid_argument(
        fmt::format("OccupancyMap: resolution must be positive, got {} m", options.resolution_m));
  }
  if (!(options.carve_range_m > 0.0)) {
    throw std::invalid_argument(fmt::format(
        "OccupancyMap: carving range must be positive, got {} m", options.carve_range_m));
  }
  const int least = options.remove_seen_through;
  if (least < 0 || least > static_cast<int>(BlockCounts::kMost) ||
      (least > 0 && !options.sticky_hits)) {
    throw std::invalid_argument(fmt::format(
        "OccupancyMap: 0 to {} clouds may see through sticky hits to take them away, got {}",
        BlockCounts::kMost, least));
  }
  const bool all_hold_points = std::all_of(clouds.begin(), clouds.end(),
                                           [](const PointCloud& c) { return !c.points.empty(); });
  if (clouds.empty() || !all_hold_points) {
    throw std::invalid_argument("OccupancyMap: every cloud needs at least 1 point");
  }
}

std::string common_crs(std::span<const PointCloud> clouds) {
  for (const PointCloud& cloud : clouds) {
    if (cloud.crs != clouds.front().crs) {
      throw InputError(
          {.file = cloud.name,
           .element = "CRS",
           .found = fmt::format("\"{}\"", cloud.crs),
           .needed = fmt::format("\"{}\" as {} has", clouds.front().crs, clouds.front().name),
           .remedy = "bring the clouds into one frame first"});
    }
  }
  return clouds.front().crs;
}

}  // namespace

Eigen::Vector3d tree_origin(const Box3& bounds, double resolution_m) {
  constexpr double near_zero_m = 4096.0;  // OctoMap computes in float
  const double range_m = std::min(near_zero_m, (kHalfRange - 1.0) * resolution_m);
  Eigen::Vector3d origin(0, 0, 0);
  for (int axis = 0; axis < 3; ++axis) {
    const double from = bounds.min_in_source[axis], to = bounds.max_in_source[axis];
    if (std::max(-from, to) > range_m) origin[axis] = std::round(0.5 * (from + to));
  }
  return origin;
}

MeasuredClouds measure_clouds(std::span<const PointCloud> clouds, const OccupancyOptions& options) {
  check(clouds, options);
  std::size_t points = 0;
  for (const PointCloud& cloud : clouds) points += cloud.points.size();
  std::string crs = common_crs(clouds);
  const Eigen::Vector3d origin = choose_origin(clouds, options.resolution_m);
  MeasuredClouds measured{origin, std::move(crs),
                          CloudMeasurements(origin, options, ScanAccumulator(options), points)};
  for (const PointCloud& cloud : clouds) measured.cells.add(cloud);
  return measured;
}

}  // namespace roadbed::map::occupancy::octree
