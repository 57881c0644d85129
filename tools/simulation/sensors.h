#pragma once

#include <algorithm>
#include <random>

#include "roadbed/control/cruise_control.h"
#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/planning/speed/lead.h"
#include "roadbed/tools/simulation/scenario.h"

namespace roadbed::tools::inline simulation {

/// What the controllers get to see: the truth plus white Gaussian noise. Deterministic by seed.
class Sensors {
 public:
  Sensors(const ScenarioNoise& noise, std::uint64_t seed) : deviations_(noise), random_(seed) {}

  planning::VehicleState measure(const planning::VehicleState& truth) {
    planning::VehicleState seen = truth;
    seen.map_from_vehicle.x_m += noise(deviations_.position_m);
    seen.map_from_vehicle.y_m += noise(deviations_.position_m);
    seen.map_from_vehicle.heading_rad += noise(deviations_.heading_rad);
    seen.speed_mps = std::max(0.0, seen.speed_mps + noise(deviations_.speed_mps));
    seen.acceleration_mps2 += noise(deviations_.acceleration_mps2);
    return seen;
  }

  /// Whether a lead is measured at a time at all; to be asked once per time.
  bool sees(double t_s) {
    const bool is_blind = std::ranges::any_of(
        deviations_.dropouts,
        [&](const planning::TimeSpan& span) { return t_s >= span.from_s && t_s < span.to_s; });
    if (is_blind || deviations_.dropout_ratio <= 0.0) return !is_blind;
    return std::uniform_real_distribution<double>(0.0, 1.0)(random_) >= deviations_.dropout_ratio;
  }

  control::LeadMeasurement measure(const planning::Lead& truth, double own_speed_mps) {
    return {.gap_m = truth.gap_m + noise(deviations_.gap_m),
            .relative_speed_mps =
                truth.speed_mps - own_speed_mps + noise(deviations_.relative_speed_mps)};
  }

 private:
  double noise(double deviation) { return deviation * normal_(random_); }

  ScenarioNoise deviations_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace roadbed::tools::simulation
