#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include <cmath>
#include <vector>

#include "occupancy_peers.h"

namespace roadbed {

struct KdTreePeer::Tree {
  pcl::KdTreeFLANN<pcl::PointXYZ> points;
};

KdTreePeer::KdTreePeer(const PeerScene& scene) : scene_(scene), tree_(new Tree) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>);
  for (const map::Box2& box : scene.boxes) {
    const Eigen::Vector2d middle = 0.5 * (box.min_in_source + box.max_in_source);
    cloud->push_back({static_cast<float>(middle.x()), static_cast<float>(middle.y()), 0.0f});
  }
  tree_->points.setInputCloud(cloud);
}

KdTreePeer::~KdTreePeer() = default;

std::size_t KdTreePeer::clear_poses(std::size_t poses) const {
  const auto circles = geometry::covering_circles(scene_.vehicle, 5);
  const map::Box2& box = scene_.boxes.front();
  const double near_m = circles.radius_m + 0.5 * (box.max_in_source - box.min_in_source).norm();
  std::size_t clear = 0;
  std::vector<int> index(1);
  std::vector<float> distance_m2(1);
  for (std::size_t i = 0; i < poses; ++i) {
    const auto& row = scene_.drive.points()[i];
    bool is_clear = true;
    for (const double x_m : circles.centres_x_m) {
      const pcl::PointXYZ at(static_cast<float>(row.x_m + x_m * std::cos(row.heading_rad)),
                             static_cast<float>(row.y_m + x_m * std::sin(row.heading_rad)), 0.0f);
      tree_->points.nearestKSearch(at, 1, index, distance_m2);
      is_clear = is_clear && static_cast<double>(distance_m2[0]) > near_m * near_m;
    }
    clear += is_clear;
  }
  return clear;
}

}  // namespace roadbed
