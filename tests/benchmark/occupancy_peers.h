#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"

namespace roadbed {

/// What other libraries are asked about: occupied boxes in plan view, and poses of a vehicle.
struct PeerScene {
  std::vector<map::Box2> boxes;
  double heights_m = 1.0;  ///< of boxes and vehicle, where the library asks for a third dimension
  const geometry::Trajectory& drive;
  geometry::VehicleShape vehicle;
};

/// Distances from five circles of each pose to the nearest middle of a box, by PCL's KdTreeFLANN.
/// @returns poses whose circles are all farther away than their radius and half a box's diagonal.
class KdTreePeer {
 public:
  explicit KdTreePeer(const PeerScene& scene);
  ~KdTreePeer();
  std::size_t clear_poses(std::size_t poses) const;

 private:
  struct Tree;
  const PeerScene& scene_;
  std::unique_ptr<Tree> tree_;
};

/// Collisions of the vehicle's box with an OcTree of the boxes, by FCL.
/// @returns poses without a collision.
class FclPeer {
 public:
  FclPeer(const PeerScene& scene, double resolution_m);
  ~FclPeer();
  std::size_t clear_poses(std::size_t poses) const;

 private:
  struct Tree;
  const PeerScene& scene_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace roadbed
