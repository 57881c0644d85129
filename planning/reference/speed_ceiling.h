#pragma once

#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline reference {

/// A speed to hold at a place, and how it changes with time while it is held.
struct SpeedTarget {
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;  ///< 0 or less: only braking is planned ahead
};

/// Greatest speed at every station such that whatever lies ahead can be met at a comfortable
/// deceleration. Immutable.
class SpeedCeiling {
 public:
  /// @param caps_mps           N ≥ 2 greatest speeds at stations 0, step, 2 step, …; 0 or more.
  /// @param deceleration_mps2  that braking ahead of a lower cap takes, positive.
  /// @throws std::invalid_argument if a number is unusable.
  SpeedCeiling(const std::vector<double>& caps_mps, double step_m, double deceleration_mps2);

  /// Speed at a station, clamped to the ceiling. Between support points v² is linear, as under a
  /// constant acceleration.
  SpeedTarget at(double s_m) const;

 private:
  std::vector<double> squared_;  ///< v² [m²/s²] per support point
  double step_m_;
};

struct SpeedCeilingOptions {
  double desired_speed_mps = 130.0 / 3.6;
  double max_lateral_acceleration_mps2 = 2.5;
  double deceleration_mps2 = 1.5;
  double steering_rate_fraction = 0.7;  ///< of the vehicle's, that bends may ask for
  double step_m = 0.5;
};

/// Ceiling along a reference line: the map's limit, the desired speed, and what the line's bends
/// allow: κ v² ≤ the lateral acceleration, and v · d(atan L κ)/ds ≤ the steering rate.
SpeedCeiling speed_ceiling(const ReferenceLine& line, const geometry::VehicleShape& vehicle,
                           const SpeedCeilingOptions& options);

/// Speed at `distance_m` from a place to stop at: constant deceleration, which fades out at the end
/// as v = distance / fade; 0 past the place. Speed and deceleration are continuous.
SpeedTarget stopping_speed(double distance_m, double deceleration_mps2, double fade_s = 1.0);

}  // namespace roadbed::planning::reference
