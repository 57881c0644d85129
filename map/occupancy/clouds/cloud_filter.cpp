#include "roadbed/map/occupancy/clouds/cloud_filter.h"

#include <fmt/format.h>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/open_module.h"
#include "roadbed/map/occupancy/clouds/pcl_filter.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

[[noreturn]] void refuse(const std::string& found, const std::string& remedy) {
  throw InputError({.file = "point cloud filter", .found = found, .remedy = remedy});
}

RoadbedPclFilter& open_module() {
  void* found = function_of_module("libroadbed_pcl", "roadbed_pcl_filter");
  if (found != nullptr) return *reinterpret_cast<RoadbedPclFilter*>(found);
  refuse("libroadbed_pcl.so cannot be opened",
         "install libpcl-dev and build roadbed again, or leave the filters out");
}

}  // namespace

PointCloud filtered(const PointCloud& cloud, const CloudFilter& filter) {
  static RoadbedPclFilter& pcl_filter = open_module();
  PointCloud kept = cloud;
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  const std::size_t count =
      pcl_filter(kept.points.front().data(), kept.points.size(), static_cast<float>(filter.voxel_m),
                 filter.outlier_neighbours, filter.outlier_deviations);
  if (count == 0) refuse(fmt::format("no point of {} is left", cloud.name), "filter less");
  kept.points.resize(count);
  return kept;
}

}  // namespace roadbed::map::occupancy::clouds
