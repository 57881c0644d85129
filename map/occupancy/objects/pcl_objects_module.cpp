// Of the module that links PCL, as clouds/pcl_module.cpp is. Never to be compiled with
// -march=native.
#include "roadbed/map/occupancy/objects/pcl_objects.h"

#include <pcl/ModelCoefficients.h>
#include <pcl/console/print.h>
#include <pcl/features/normal_3d.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/approximate_progressive_morphological_filter.h>
#include <pcl/segmentation/sac_segmentation.h>

#include <algorithm>
#include <cmath>

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr cloud_of(const float* xyz, std::size_t count) {
  Cloud::Ptr cloud(new Cloud);
  cloud->reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    cloud->push_back({xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]});
  }
  return cloud;
}

pcl::search::KdTree<pcl::PointXYZ>::Ptr tree_of(const Cloud::ConstPtr& cloud) {
  pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
  tree->setInputCloud(cloud);
  return tree;
}

}  // namespace

bool roadbed_pcl_plane(const float* xyz, std::size_t count, float slope, float near, float* plane) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // none found is an answer
  pcl::SACSegmentation<pcl::PointXYZ> segmentation;  // by a random sequence that is always the same
  segmentation.setInputCloud(cloud_of(xyz, count));
  segmentation.setModelType(pcl::SACMODEL_PERPENDICULAR_PLANE);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setAxis(Eigen::Vector3f::UnitZ());
  segmentation.setEpsAngle(std::atan(slope));
  segmentation.setDistanceThreshold(near);
  segmentation.setMaxIterations(500);
  pcl::PointIndices inliers;
  pcl::ModelCoefficients found;
  segmentation.segment(inliers, found);
  if (inliers.indices.empty() || found.values.size() != 4 || found.values[2] == 0.0f) return false;
  const std::size_t terms[] = {0, 1, 3};
  for (std::size_t i = 0; i < 3; ++i) plane[i] = -found.values[terms[i]] / found.values[2];
  return true;
}

void roadbed_pcl_ground(const float* xyz, std::size_t count, const RoadbedPclGroundOptions* options,
                        std::uint8_t* is_ground) {
  pcl::ApproximateProgressiveMorphologicalFilter<pcl::PointXYZ> filter;
  filter.setInputCloud(cloud_of(xyz, count));
  filter.setCellSize(options->cell);
  filter.setSlope(options->slope);
  filter.setInitialDistance(options->least_height);
  filter.setMaxDistance(options->most_height);
  filter.setMaxWindowSize(static_cast<int>(options->widest));
  filter.setNumberOfThreads(1);
  pcl::Indices ground;
  filter.extract(ground);
  std::fill_n(is_ground, count, std::uint8_t{0});
  for (const pcl::index_t i : ground) is_ground[i] = 1;
}

void roadbed_pcl_normals(const float* xyz, std::size_t count, int neighbours,
                         const float* viewpoint, float* normals) {
  const Cloud::ConstPtr cloud = cloud_of(xyz, count);
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(tree_of(cloud));
  estimation.setKSearch(neighbours);
  estimation.setViewPoint(viewpoint[0], viewpoint[1], viewpoint[2]);
  pcl::PointCloud<pcl::Normal> found;
  estimation.compute(found);
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(found[i].normal, 3, normals + 3 * i);
  }
}
