#pragma once

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::control {

/// Kinematic single-track model at the rear axle, as CommonRoad's KS:
/// ẋ = v cos ψ, ẏ = v sin ψ, ψ̇ = v tan(δ)/L, v̇ = a, δ̇ = limited steering rate.
struct SingleTrackState {
  geometry::Pose2 pose{};  ///< map_from_vehicle
  double speed_mps = 0.0;
  double steering_rad = 0.0;
};

struct SingleTrackInput {
  double acceleration_mps2 = 0.0;
  double steering_rate_radps = 0.0;
};

/// State after `step_s` of constant input (classic Runge–Kutta). Speed stays ≥ 0, steering angle
/// and rate within the vehicle's limits.
SingleTrackState step(const SingleTrackState& state, const SingleTrackInput& input, double step_s,
                      const geometry::VehicleShape& vehicle);

}  // namespace roadbed::control
