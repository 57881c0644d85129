#include <fcl/fcl.h>
#include <fcl/geometry/octree/octree.h>
#include <octomap/octomap.h>

#include <memory>

#include "occupancy_peers.h"

namespace roadbed {

struct FclPeer::Tree {
  std::unique_ptr<fcl::CollisionObjectd> boxes, car;
};

FclPeer::FclPeer(const PeerScene& scene, double resolution_m) : scene_(scene), tree_(new Tree) {
  auto octree = std::make_shared<octomap::OcTree>(resolution_m);
  for (const map::Box2& box : scene.boxes) {
    const Eigen::Vector2d middle = 0.5 * (box.min_in_source + box.max_in_source);
    for (double z_m = 0.5 * resolution_m; z_m < scene.heights_m; z_m += resolution_m) {
      octree->updateNode(middle.x(), middle.y(), z_m, true, true);
    }
  }
  octree->updateInnerOccupancy();
  octree->prune();
  tree_->boxes = std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::OcTreed>(octree));
  tree_->car = std::make_unique<fcl::CollisionObjectd>(
      std::make_shared<fcl::Boxd>(scene.vehicle.length_m, scene.vehicle.width_m, scene.heights_m));
}

FclPeer::~FclPeer() = default;

std::size_t FclPeer::clear_poses(std::size_t poses) const {
  std::size_t clear = 0;
  const double middle_m = 0.5 * scene_.vehicle.length_m - scene_.vehicle.rear_overhang_m;
  for (std::size_t i = 0; i < poses; ++i) {
    const auto& row = scene_.drive.points()[i];
    fcl::Transform3d at = fcl::Transform3d::Identity();
    at.linear() = Eigen::AngleAxisd(row.heading_rad, Eigen::Vector3d::UnitZ()).matrix();
    at.translation() =
        Eigen::Vector3d(row.x_m, row.y_m, 0.5 * scene_.heights_m) + middle_m * at.linear().col(0);
    tree_->car->setTransform(at);
    tree_->car->computeAABB();
    fcl::CollisionResultd result;
    clear +=
        fcl::collide(tree_->car.get(), tree_->boxes.get(), fcl::CollisionRequestd(), result) == 0;
  }
  return clear;
}

}  // namespace roadbed
