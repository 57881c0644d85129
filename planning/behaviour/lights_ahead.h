#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/planning/behaviour/light_cycle.h"
#include "roadbed/planning/behaviour/st_graph.h"
#include "roadbed/planning/behaviour/stop_points.h"

namespace roadbed::planning::inline behaviour {

/// A light on a path: how far the rear axle may drive until the front bumper is at its line.
struct LightAhead {
  const StopPoint& place;
  const LightCycle& light;
  double line_m;
};

/// Blocks what is behind the line of a red light; of a yellow one too where it can be stopped at.
/// @param start_s  time of the occupancy's step 0, which has `steps` more.
void block_light(const LightAhead& ahead, double start_s, int steps, bool can_stop,
                 StGraph& occupancy);

/// "light 51 is red, 12.3 m ahead", of the first one that is; none: all are green, passed, or far.
std::optional<std::string> why_light_stops(std::span<const LightAhead> lights, double t_s);

}  // namespace roadbed::planning::behaviour
