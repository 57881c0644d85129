#pragma once

#include <span>
#include <vector>

namespace roadbed::planning::inline lateral {

/// Speed ahead: the current longitudinal plan.
struct SpeedPlan {
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;
  double target_mps = 0.0;  ///< the acceleration holds until this speed is near, then fades
};

/// One sample of a speed profile that was planned elsewhere.
struct SpeedSample {
  double distance_m = 0.0;  ///< from now
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;
};

/// A speed plan as a function of the distance travelled, with finite jerk.
///
/// With w = v², dw/dl = 2a holds until the target is near, then w approaches the target's square
/// exponentially over the length λ = v_target · 1 s, so that the acceleration is continuous. If
/// the acceleration leads away from the target, it holds on: down to standstill, or up.
class PlannedSpeed {
 public:
  /// @throws std::invalid_argument if a value is not finite or a speed is negative.
  explicit PlannedSpeed(const SpeedPlan& plan);

  /// A profile: w is cubic between its samples with the slopes 2a, so that the acceleration is
  /// continuous; where that would pass under 0 the vehicle stands. Before the first and after the
  /// last sample the speed is theirs.
  /// @throws std::invalid_argument if there is no sample, a value is not finite, a speed is
  ///         negative or a distance does not increase.
  explicit PlannedSpeed(std::span<const SpeedSample> profile);

  struct State {
    double speed_mps;
    double acceleration_mps2;
    double jerk_mps3;
  };

  /// State after `distance_m` ≥ 0.
  State at(double distance_m) const;

 private:
  State in_profile(double distance_m) const;

  std::vector<SpeedSample> profile_;  // if there is any, nothing below counts
  double start_squared_ = 0.0;        // w at distance 0
  double acceleration_mps2_ = 0.0;    // in the first phase
  double target_squared_ = 0.0;       // w that the second phase approaches
  double fade_from_m_ = 0.0;          // where the second phase begins; infinite if there is none
  double fade_length_m_ = 1.0;        // λ
};

}  // namespace roadbed::planning::lateral
