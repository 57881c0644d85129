#include "roadbed/planning/speed/speed_question.h"

#include <cmath>

namespace roadbed::planning::inline speed {
namespace {

/// After a while of going on moving; a negative speed is one of a vehicle that has come to rest.
SpeedState moved(const SpeedState& from, double command_mps2, double for_s) {
  constexpr double kLag_s = geometry::kLongitudinal.actuator_lag_s;
  const double decay = std::exp(-for_s / kLag_s), lag_way_s = kLag_s * (1.0 - decay);
  const double lagging_mps2 = from.acceleration_mps2 - command_mps2;
  return {.t_s = from.t_s + for_s,
          .ahead_m = from.ahead_m + from.speed_mps * for_s + 0.5 * command_mps2 * for_s * for_s +
                     lagging_mps2 * kLag_s * (for_s - lag_way_s),
          .speed_mps = from.speed_mps + command_mps2 * for_s + lagging_mps2 * lag_way_s,
          .acceleration_mps2 = command_mps2 + lagging_mps2 * decay,
          .command_mps2 = command_mps2};
}

}  // namespace

SpeedState followed(const SpeedState& from, double command_mps2, double for_s) {
  const SpeedState end = moved(from, command_mps2, for_s);
  if (end.speed_mps >= 0.0) return end;
  double moves_s = 0.0, rests_s = for_s;
  for (int i = 0; i < 40; ++i) {
    const double middle_s = 0.5 * (moves_s + rests_s);
    (moved(from, command_mps2, middle_s).speed_mps > 0.0 ? moves_s : rests_s) = middle_s;
  }
  return {.t_s = end.t_s,
          .ahead_m = moved(from, command_mps2, moves_s).ahead_m,
          .command_mps2 = command_mps2};
}

}  // namespace roadbed::planning::speed
