#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/octree/cloud_measurements.h"

namespace roadbed::map::inline occupancy::inline octree {
namespace {

void check(const OccupancyOptions& options) {
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
}

/// What there is to know of all clouds before the first cell.
struct Survey {
  std::size_t clouds = 0, points = 0;
  std::string name, crs;  // of the first
  Box3 box;

  void add(const PointCloud& cloud) {
    if (cloud.points.empty()) refuse_empty();
    const Box3 around = bounds(cloud);
    if (clouds == 0) *this = {0, 0, cloud.name, cloud.crs, around};
    ++clouds;
    points += cloud.points.size();
    box.extend(around);
    if (cloud.crs == crs) return;
    throw InputError({.file = cloud.name,
                      .element = "CRS",
                      .found = fmt::format("\"{}\"", cloud.crs),
                      .needed = fmt::format("\"{}\" as {} has", crs, name),
                      .remedy = "bring the clouds into one frame first"});
  }

  [[noreturn]] static void refuse_empty() {
    throw std::invalid_argument("OccupancyMap: every cloud needs at least 1 point");
  }
};

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

MeasuredClouds measure_clouds(const CloudsInTurn& clouds, const OccupancyOptions& options) {
  check(options);
  Survey survey;
  clouds([&](const PointCloud& cloud) { survey.add(cloud); });
  if (survey.clouds == 0) Survey::refuse_empty();
  const Eigen::Vector3d origin = tree_origin(survey.box, options.resolution_m);
  MeasuredClouds measured{
      origin, survey.crs,
      CloudMeasurements(origin, options, ScanAccumulator(options), survey.points)};
  clouds([&](const PointCloud& cloud) { measured.cells.add(cloud); });
  return measured;
}

}  // namespace roadbed::map::occupancy::octree
