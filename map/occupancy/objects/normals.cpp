#include "roadbed/map/occupancy/objects/normals.h"

#include "roadbed/map/occupancy/clouds/pcl_function.h"
#include "roadbed/map/occupancy/objects/pcl_objects.h"

namespace roadbed::map::inline occupancy::inline objects {

std::vector<Eigen::Vector3f> normals(const PointCloud& cloud, int neighbours) {
  static auto& estimate = pcl_function_as<RoadbedPclNormals>("roadbed_pcl_normals");
  constexpr double far_above_m = 1e6;
  const Eigen::Vector3d sensor = cloud.sensor_in_source.value_or(
      cloud.origin_in_source + Eigen::Vector3d(0.0, 0.0, far_above_m));
  const Eigen::Vector3f viewpoint = (sensor - cloud.origin_in_source).cast<float>();
  std::vector<Eigen::Vector3f> found(cloud.points.size());
  estimate(cloud.points.front().data(), cloud.points.size(), neighbours, viewpoint.data(),
           found.front().data());
  return found;
}

}  // namespace roadbed::map::occupancy::objects
