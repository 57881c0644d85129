#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/planning/speed/st_graph.h"
#include "roadbed/planning/task/stop_points.h"

namespace roadbed::planning::inline right_of_way {

/// A light on a path: how far the rear axle may drive until the front bumper is at its line.
struct LightAhead {
  const StopPoint& place;
  const LightCycle& light;
  double line_m;
};

/// Blocks what is behind the line of a red light; of a yellow one too where it can be stopped at.
/// @param start_s  time of the occupancy's step 0, which has `steps` more.
inline void block_light(const LightAhead& ahead, double start_s, int steps, bool can_stop,
                        StGraph& occupancy) {
  constexpr double kLeastWay_m = 0.01;
  constexpr double kBeforeLight_m = 0.3;  // kept from a light's line
  constexpr double kAtLight_m = 4.0;      // more than is driven in a step of the search
  if (ahead.line_m <= 0.0) return;
  for (int k = 0; k <= steps; ++k) {
    const LightColour colour = colour_at(ahead.light, start_s + StGraph::kStep_s * k);
    if (colour == LightColour::green || (colour == LightColour::yellow && !can_stop)) continue;
    occupancy.block(k, std::max(kLeastWay_m, ahead.line_m - kBeforeLight_m),
                    ahead.line_m + kAtLight_m);
  }
}

/// "light 51 is red, 12.3 m ahead", of the first one that is; none: all are green, passed, or far.
inline std::optional<std::string> why_light_stops(std::span<const LightAhead> lights, double t_s) {
  constexpr double kLightAhead_m = 60.0;
  for (const LightAhead& ahead : lights) {
    const LightColour colour = colour_at(ahead.light, t_s);
    const bool is_near = ahead.line_m > 0.0 && ahead.line_m <= kLightAhead_m;
    if (!is_near || colour == LightColour::green) continue;
    return fmt::format("{} is {}, {:.1f} m ahead", ahead.place.name, to_string(colour),
                       ahead.line_m);
  }
  return std::nullopt;
}

}  // namespace roadbed::planning::right_of_way
