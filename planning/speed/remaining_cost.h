#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/planning/speed/speed_question.h"

namespace roadbed::planning::inline speed {

/// Where a drive of a speed search is at the end of a layer of time.
struct SpeedSearchPlace {
  double t_s, ahead_m, speed_mps, acceleration_mps2;
};

/// What a drive will at least cost yet, whatever the traffic: bounds that let a search go on with
/// the right state first.
class RemainingCost {
 public:
  /// @param question  kept by reference.
  /// @param layer_s   in which a command is constant; `end_s` is the last layer's end.
  RemainingCost(const SpeedSearchQuestion& question, const SpeedSearchOptions& options,
                double layer_s, double end_s)
      : q_(question),
        options_(options),
        layer_s_(layer_s),
        end_s_(end_s),
        wanted_mps_(least_wanted_to_end_mps()) {
    const double h = layer_s, lag_s = options.actuator_lag_s, decay = std::exp(-h / lag_s);
    lead_s2_ = lag_s * (0.5 * h - lag_s + h * decay / (1.0 - decay));
  }

  /// By how much a goal will at least be missed, by the strongest commands [m].
  double miss(const SpeedSearchPlace& at, const GoalAhead& goal, double slack_s) const {
    const double last_s = goal.time_s.most + slack_s - at.t_s;
    if (last_s < 0.0) return std::numeric_limits<double>::infinity();
    const double first_s = std::max(0.0, goal.time_s.least - slack_s - at.t_s);
    return std::max({0.0, goal.ahead_m.least - at.ahead_m - farthest_m(at, last_s),
                     at.ahead_m + nearest_m(at, first_s) - goal.ahead_m.most});
  }

  /// Of the speed that will be missing so that the drive stays before the end of the path. With the
  /// layers' length h and the actuator's lag T, the speeds v at the ends of n layers and the way w
  /// are, exactly,
  ///
  ///     h (v_1 + … + v_n) = w + h/2 (v_n − v_0) + k (a_n − a_0),  k = T (h/2 − T + h δ/(1 − δ)),
  ///
  /// δ = e^(−h/T), but for up to h²/2 of the braking where the drive comes to rest. Under that the
  /// sum of squares of what is missing is least if it is the same in all layers, and half of it in
  /// the last one.
  double before_end(const SpeedSearchPlace& at) const {
    const double h = layer_s_, n = std::round((end_s_ - at.t_s) / h);
    if (n < 1.0) return 0.0;
    const double lead_m = lead_s2_ * (options_.most_mps2 - at.acceleration_mps2) -
                          0.5 * h * at.speed_mps - 0.5 * options_.least_mps2 * h * h;
    const double sum_mps = (q_.end_m - at.ahead_m + lead_m) / h;
    const double missing_mps = ((n - 0.5) * wanted_mps_ - sum_mps) / (n - 0.75);
    if (missing_mps <= 0.0) return 0.0;
    const double missing = missing_mps / std::max(5.0, wanted_mps_);
    return h * (n - 0.75) * missing * missing;
  }

 private:
  double least_wanted_to_end_mps() const {
    double least = q_.most_wanted_mps;
    for (std::size_t i = 0; i < q_.profile.ahead_m.size(); ++i) {
      if (q_.profile.ahead_m[i] > q_.end_m) break;
      least = std::min(least, q_.profile.wanted_mps[i]);
    }
    return least;
  }

  /// No drive comes farther within a time.
  double farthest_m(const SpeedSearchPlace& at, double within_s) const {
    const double lag_s = options_.actuator_lag_s, most = options_.most_mps2;
    const double lagging_s = lag_s * (1.0 - std::exp(-within_s / lag_s));
    return at.speed_mps * within_s + 0.5 * most * within_s * within_s +
           (std::max(0.0, at.acceleration_mps2) - most) * lag_s * (within_s - lagging_s);
  }

  /// Every drive comes as far within a time.
  double nearest_m(const SpeedSearchPlace& at, double within_s) const {
    const double least = std::min({-1e-3, options_.least_mps2, at.acceleration_mps2});
    const double braking_s = std::min(within_s, at.speed_mps / -least);
    return braking_s * (at.speed_mps + 0.5 * least * braking_s);
  }

  const SpeedSearchQuestion& q_;
  const SpeedSearchOptions& options_;
  double layer_s_, end_s_, wanted_mps_, lead_s2_ = 0.0;
};

}  // namespace roadbed::planning::speed
