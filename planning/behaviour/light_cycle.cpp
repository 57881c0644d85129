#include "roadbed/planning/behaviour/light_cycle.h"

#include <cmath>

namespace roadbed::planning::inline behaviour {

LightColour colour_at(const LightCycle& light, double t_s) {
  double cycle_s = 0.0;
  for (const LightPhase& phase : light.phases) cycle_s += phase.duration_s;
  double in_cycle_s = std::fmod(t_s - light.offset_s, cycle_s);
  if (in_cycle_s < 0.0) in_cycle_s += cycle_s;
  for (const LightPhase& phase : light.phases) {
    if (in_cycle_s < phase.duration_s) return phase.colour;
    in_cycle_s -= phase.duration_s;
  }
  return light.phases.back().colour;
}

}  // namespace roadbed::planning::behaviour
