#pragma once

#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::planning::inline behaviour {

/// State of the own vehicle, true or measured; the pose is that of its rear axle.
struct VehicleState {
  geometry::Pose2 map_from_vehicle{};
  double speed_mps = 0.0;
  double steering_rad = 0.0;
  double acceleration_mps2 = 0.0;
};

}  // namespace roadbed::planning::behaviour
