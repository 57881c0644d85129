// The only file that sees PCL. Never to be compiled with -march=native: Debian's PCL is not, and
// Eigen's alignment would differ between the two.
#include "roadbed/map/occupancy/clouds/pcl_filter.h"

#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr without_outliers(const Cloud::ConstPtr& cloud, int neighbours, double deviations) {
  Cloud::Ptr kept(new Cloud);
  pcl::StatisticalOutlierRemoval<pcl::PointXYZ> filter;
  filter.setInputCloud(cloud);
  filter.setMeanK(neighbours);
  filter.setStddevMulThresh(deviations);
  filter.filter(*kept);
  return kept;
}

Cloud::Ptr thinned(const Cloud::ConstPtr& cloud, float voxel_m) {
  Cloud::Ptr kept(new Cloud);
  pcl::VoxelGrid<pcl::PointXYZ> filter;
  filter.setInputCloud(cloud);
  filter.setLeafSize(voxel_m, voxel_m, voxel_m);
  filter.filter(*kept);
  return kept;
}

void find_nearest(const Cloud::ConstPtr& all, const Cloud& of, std::uint32_t* nearest) {
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(all);
  pcl::Indices found(1);
  std::vector<float> distances(1);
  for (std::size_t i = 0; i < of.size(); ++i) {
    tree.nearestKSearch(of[i], 1, found, distances);
    nearest[i] = static_cast<std::uint32_t>(found[0]);
  }
}

}  // namespace

std::size_t roadbed_pcl_filter(float* xyz, std::uint32_t* nearest, std::size_t count, float voxel_m,
                               int neighbours, double deviations) {
  Cloud::Ptr cloud(new Cloud);
  for (std::size_t i = 0; i < count; ++i) {
    cloud->push_back({xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]});
  }
  const Cloud::ConstPtr all = cloud;
  if (neighbours > 0) cloud = without_outliers(cloud, neighbours, deviations);
  if (voxel_m > 0.0f) cloud = thinned(cloud, voxel_m);
  if (nearest != nullptr) find_nearest(all, *cloud, nearest);
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    xyz[3 * i] = (*cloud)[i].x;
    xyz[3 * i + 1] = (*cloud)[i].y;
    xyz[3 * i + 2] = (*cloud)[i].z;
  }
  return cloud->size();
}
