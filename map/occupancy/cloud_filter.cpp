#include "roadbed/map/occupancy/cloud_filter.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "roadbed/map/input_error.h"
#include "roadbed/map/occupancy/pcl_filter.h"

namespace roadbed::map {
namespace {

[[noreturn]] void refuse(const std::string& found, const std::string& remedy) {
  throw InputError({.file = "point cloud filter",
                    .place = {},
                    .element = {},
                    .found = found,
                    .needed = {},
                    .remedy = remedy});
}

// Beside the program, as it is installed, or in the build's folder of libraries.
RoadbedPclFilter& open_module() {
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
  const std::filesystem::path folder = program.parent_path();
  for (const auto& place : {folder, folder / "../lib"}) {
    void* module = ::dlopen((place / "libroadbed_pcl.so").c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) continue;
    void* symbol = ::dlsym(module, "roadbed_pcl_filter");
    if (symbol != nullptr) return *reinterpret_cast<RoadbedPclFilter*>(symbol);
  }
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

}  // namespace roadbed::map
