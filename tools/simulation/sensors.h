#pragma once

#include <random>

#include "roadbed/control/cruise_control.h"
#include "roadbed/planning/behaviour/lead.h"
#include "roadbed/planning/behaviour/vehicle_state.h"
#include "roadbed/tools/simulation/scenario.h"

namespace roadbed::tools::inline simulation {

/// What the controllers get to see: the truth plus white Gaussian noise. Deterministic by seed.
class Sensors {
 public:
  Sensors(const ScenarioNoise& noise, std::uint64_t seed);

  planning::VehicleState measure(const planning::VehicleState& truth);

  /// Whether a lead is measured at a time at all; to be asked once per time.
  bool sees(double t_s);
  control::LeadMeasurement measure(const planning::Lead& truth, double own_speed_mps);

 private:
  double noise(double deviation);

  ScenarioNoise deviations_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace roadbed::tools::simulation
