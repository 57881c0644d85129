#pragma once

#include <string>
#include <vector>

namespace roadbed::planning::inline behaviour {

enum class LightColour { green, yellow, red };

struct LightPhase {
  LightColour colour = LightColour::red;
  double duration_s = 0.0;  ///< positive
};

/// Signals that show the same, and what they show: phase after phase, over and over.
struct LightCycle {
  std::vector<std::string> signals;  ///< source ids of the map's signals
  std::string pointer;               ///< JSON pointer of the light in its file
  double offset_s = 0.0;             ///< the first phase begins then
  std::vector<LightPhase> phases;    ///< at least one
};

/// What a light shows at a time.
LightColour colour_at(const LightCycle& light, double t_s);

}  // namespace roadbed::planning::behaviour
