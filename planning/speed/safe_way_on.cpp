#include "roadbed/planning/speed/safe_way_on.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbed::planning::inline speed {
namespace {

constexpr int kSpeedSteps = 3;     // over which the speed of others is taken
constexpr double kAtRest_m = 0.1;  // of a state that stands where it has to

/// Speed along the path of who is ahead at a step; 0 for what was not there before.
double speed_of(const StInterval& part, const StGraph& occupancy, int step) {
  const int before = std::max(0, step - kSpeedSteps);
  if (before == step) return 0.0;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const StInterval& other : occupancy.at(before)) {
    const double moved_m = part.from_m - other.from_m;
    if (other.obstacle == part.obstacle && std::abs(moved_m) < std::abs(nearest_m)) {
      nearest_m = moved_m;
    }
  }
  return std::isfinite(nearest_m) ? nearest_m / (StGraph::kStep_s * (step - before)) : 0.0;
}

}  // namespace

std::optional<std::size_t> who_bars_way_on(const SpeedState& last, const StGraph& occupancy,
                                           double end_m, const std::vector<bool>& ignored,
                                           double braking_mps2) {
  // With the lag T, s + T v and v + T a follow the command as a double integrator does.
  const double lag_s = geometry::kLongitudinal.actuator_lag_s;
  const double lagging_mps = std::max(0.0, last.speed_mps + lag_s * last.acceleration_mps2);
  const double stop_m =
      lag_s * last.speed_mps + 0.5 * lagging_mps * lagging_mps / braking_mps2 - kAtRest_m;
  const double stop_s = lag_s + lagging_mps / braking_mps2;
  if (last.ahead_m + stop_m > end_m) return StInterval::kNoObstacle;
  const int step = static_cast<int>(std::lround(last.t_s / StGraph::kStep_s));
  for (const StInterval& part : occupancy.at(step)) {
    const bool is_ignored = part.obstacle < ignored.size() && ignored[part.obstacle];
    if (is_ignored || part.from_m < last.ahead_m) continue;
    const double other_mps = speed_of(part, occupancy, step);
    const double drives_on_m =
        other_mps > 0.0 ? 0.5 * other_mps * other_mps / braking_mps2 : other_mps * stop_s;
    if (last.ahead_m + stop_m > part.from_m + drives_on_m) return part.obstacle;
  }
  return std::nullopt;
}

}  // namespace roadbed::planning::speed
