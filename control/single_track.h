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

/// What moves it over a step.
struct SingleTrackInput {
  double acceleration_mps2 = 0.0;
  double steering_rate_radps = 0.0;
};

/// State after `step_s` of constant input (classic Runge–Kutta). Speed stays ≥ 0, steering angle
/// and rate within the vehicle's limits.
SingleTrackState step(const SingleTrackState& state, const SingleTrackInput& input, double step_s,
                      const geometry::VehicleShape& vehicle);

/// Mass and tyres of a single-track vehicle that slips; lengths from the centre of gravity.
struct DynamicVehicle {
  double mass_kg, yaw_inertia_kgm2;
  double front_axle_m, rear_axle_m, height_m;  ///< of the centre of gravity to axles and ground
  double max_steering_rad, max_steering_rate_radps;
  double friction = 1.0489;
  double cornering_stiffness_per_rad = 21.92 / 1.0489;  ///< per unit of load and friction
};

/// CommonRoad's parameter sets 1 (Ford Escort), 2 (BMW 320i) and 3 (VW Vanagon).
/// @throws std::invalid_argument for another number.
DynamicVehicle common_road_vehicle(int number);

/// State of the centre of gravity.
struct DynamicState {
  geometry::Pose2 pose{};  ///< heading is the body's, not that of motion
  double speed_mps = 0.0;
  double steering_rad = 0.0;
  double yaw_rate_radps = 0.0;
  double slip_rad = 0.0;  ///< β: direction of motion minus heading
};

/// State after `step_s` of constant input (classic Runge–Kutta) by the linear-tyre single-track
/// model with load transfer, ST of [Althoff, Würsching 2020, CommonRoad: Vehicle Models, section
/// 7]; below 0.1 m/s it rolls without slip, and slowly driven steps are divided, as slip is stiff
/// there. Steering angle and rate keep to the vehicle's limits, the speed stays ≥ 0.
DynamicState step(const DynamicState& state, const SingleTrackInput& input, double step_s,
                  const DynamicVehicle& vehicle);

}  // namespace roadbed::control
