#include "roadbed/map/occupancy/clouds/cloud_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/clouds/pcl_filter.h"
#include "roadbed/map/occupancy/clouds/pcl_function.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

// Keeps the points for which `keeps(point, sensor)`, in place; scans keep what is left of theirs.
template <class Keeps>
void keep(PointCloud& cloud, const Keeps& keeps) {
  std::vector<ScanStart> scans;
  std::size_t kept = 0, next_scan = 0;
  const std::optional<Eigen::Vector3d>* sensor = &cloud.sensor_in_source;
  bool has_begun = false;  // whether the scan has a point that is kept
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (next_scan < cloud.scans.size() && cloud.scans[next_scan].first == i) {
      sensor = &cloud.scans[next_scan++].sensor_in_source;
      has_begun = false;
    }
    if (!keeps(cloud.in_source(i), *sensor)) continue;
    if (!cloud.scans.empty() && !std::exchange(has_begun, true)) scans.push_back({kept, *sensor});
    cloud.points[kept++] = cloud.points[i];
  }
  cloud.filtered_out += cloud.points.size() - kept;
  cloud.points.resize(kept);
  cloud.scans = std::move(scans);
}

// The scans of a cloud whose points are those nearest to points of a cloud with scans; puts the
// points in the order of those.
void take_scans(PointCloud& cloud, const std::vector<std::uint32_t>& nearest) {
  std::vector<std::size_t> order(cloud.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return nearest[i]; });
  std::vector<Eigen::Vector3f> points;
  std::vector<ScanStart> scans;
  std::size_t next_scan = 0;
  for (const std::size_t i : order) {
    bool is_next = false;
    for (; next_scan < cloud.scans.size() && cloud.scans[next_scan].first <= nearest[i];
         ++next_scan) {
      is_next = true;
    }
    if (is_next) scans.push_back({points.size(), cloud.scans[next_scan - 1].sensor_in_source});
    points.push_back(cloud.points[i]);
  }
  cloud.points = std::move(points);
  cloud.scans = std::move(scans);
}

// PCL counts voxels in 32 bits, and leaves all points where they are too many.
void check_voxels(const PointCloud& cloud, double voxel_m) {
  if (!(voxel_m > 0.0)) return;
  const Box3 box = bounds(cloud);
  const Eigen::Vector3d extent_m = box.max_in_source - box.min_in_source;
  const double voxels = (extent_m / voxel_m + Eigen::Vector3d::Constant(2.0)).prod();
  constexpr double most = std::numeric_limits<std::int32_t>::max();
  if (voxels < most) return;
  throw InputError(
      {.file = cloud.name,
       .element = "voxel",
       .found = fmt::format("{:.3g} voxels of {} m around its points", voxels, voxel_m),
       .needed = fmt::format("fewer than {:.0f}", most),
       .remedy = "give larger voxels, or take points near the sensor (--range)"});
}

}  // namespace

PointCloud without_vehicle(PointCloud cloud, const CloudFilter& filter) {
  if (!filter.vehicle_box) return cloud;
  keep(cloud, [&](const Eigen::Vector3d& point, const std::optional<Eigen::Vector3d>&) {
    return !filter.vehicle_box->holds(point);
  });
  return cloud;
}

PointCloud leaving_out(PointCloud cloud,
                       const std::function<bool(const Eigen::Vector3d& in_source)>& leaves_out) {
  keep(cloud, [&](const Eigen::Vector3d& point, const std::optional<Eigen::Vector3d>&) {
    return !leaves_out(point);
  });
  return cloud;
}

PointCloud within_reach(PointCloud cloud, const CloudFilter& filter, const std::string& remedy) {
  if (!filter.range_m && !filter.height_m) return cloud;
  const ValueRange height_m = filter.height_m.value_or(ValueRange());
  const bool is_around_sensor = cloud.is_around_sensor;
  keep(cloud, [&](const Eigen::Vector3d& point, const std::optional<Eigen::Vector3d>& sensor) {
    if (!height_m.holds(point.z())) return false;
    if (!filter.range_m) return true;
    if (sensor) return filter.range_m->holds((point - *sensor).norm());
    if (is_around_sensor) return filter.range_m->holds(point.norm());
    throw InputError({.file = cloud.name,
                      .element = "range",
                      .found = "does not say where its sensor was",
                      .needed = "the sensor's position",
                      .remedy = remedy});
  });
  return cloud;
}

PointCloud filtered(const PointCloud& cloud, const CloudFilter& filter) {
  check_voxels(cloud, filter.voxel_m);
  static auto& pcl_filter = pcl_function_as<RoadbedPclFilter>("roadbed_pcl_filter");
  PointCloud kept = cloud;
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  std::vector<std::uint32_t> nearest(cloud.scans.empty() ? 0 : cloud.points.size());
  const std::size_t count = pcl_filter(
      kept.points.front().data(), nearest.empty() ? nullptr : nearest.data(), kept.points.size(),
      static_cast<float>(filter.voxel_m), filter.outlier_neighbours, filter.outlier_deviations);
  if (count == 0) {
    throw InputError({.file = "point cloud filter",
                      .found = fmt::format("no point of {} is left", cloud.name),
                      .remedy = "filter less"});
  }
  kept.points.resize(count);
  if (!nearest.empty()) take_scans(kept, nearest);
  return kept;
}

}  // namespace roadbed::map::occupancy::clouds
