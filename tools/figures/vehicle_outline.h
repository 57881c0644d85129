#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::tools::inline figures {

/// Corners of a vehicle, or of anything else that is rectangular.
inline std::vector<Eigen::Vector2d> outline_at(const geometry::Pose2& pose,
                                               const geometry::VehicleShape& shape) {
  std::vector<Eigen::Vector2d> ring;
  for (const Eigen::Vector2d& corner : shape.corners_in_vehicle()) {
    ring.push_back((pose * geometry::Pose2{corner.x(), corner.y(), 0.0}).position());
  }
  return ring;
}

}  // namespace roadbed::tools::figures
