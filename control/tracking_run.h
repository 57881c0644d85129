#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/control/sampled_path.h"
#include "roadbed/control/single_track.h"

namespace roadbed::control {

enum class SteeringLaw { stanley, original_stanley, pure_pursuit };

/// How a vehicle is sent along a path at constant speed, and by which law.
struct TrackingOptions {
  SteeringLaw law = SteeringLaw::stanley;
  double speed_mps = 10.0;
  double step_s = 0.01;  ///< of law and vehicle
  /// The heading of the path is taken where the front axle will be after this time. Half a step
  /// makes up for the steering angle being held over a whole one.
  double preview_s = 0.0;
  double original_gain_per_s = 0.5;  ///< k of paper eq. 31
  /// Explicit Euler steps, the wheels turn at once: as peers simulate. Otherwise the single-track
  /// model with its limited steering rate.
  bool euler = false;
  geometry::VehicleShape vehicle{};
  std::optional<DynamicVehicle> slips = {};  ///< drives in place of the kinematic model
  double start_offset_m = 0.0;               ///< of the rear axle, to the left of the path
  /// Standard deviations of what the law sees, white; rows hold the truth.
  double position_noise_m = 0.0, heading_noise_rad = 0.0;
  std::uint64_t seed = 1;
};

/// One step of a run: errors of the front axle at its start, and what the law made of them.
struct TrackingSample {
  double t_s = 0.0;
  SingleTrackState state;
  double cross_track_m = 0.0;  ///< positive: the path is to the left
  double heading_rad = 0.0;    ///< path minus vehicle
  double steering_rate_radps = 0.0;
  double lateral_jerk_mps3 = 0.0;  ///< d/dt of v² tan(δ)/L at constant speed
};

/// Drives from the path's start, rear axle on it or beside it and aligned with it, until the front
/// axle reaches its end.
/// @throws std::invalid_argument if speed or step is not positive.
std::vector<TrackingSample> track_path(const SampledPath& path, const TrackingOptions& options);

/// Largest values and root mean squares of a run.
struct TrackingSummary {
  double cross_track_rms_m = 0.0, largest_cross_track_m = 0.0;
  double largest_steering_rad = 0.0;
  double heading_rms_rad = 0.0, largest_heading_rad = 0.0;
  double steering_rate_rms_radps = 0.0, largest_steering_rate_radps = 0.0;
  double lateral_jerk_rms_mps3 = 0.0, largest_lateral_jerk_mps3 = 0.0;
};
TrackingSummary summarise(const std::vector<TrackingSample>& run);

}  // namespace roadbed::control
