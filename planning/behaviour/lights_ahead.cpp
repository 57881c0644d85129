#include "roadbed/planning/behaviour/lights_ahead.h"

#include <fmt/format.h>

#include <algorithm>

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kBeforeLight_m = 0.3;  // kept from a light's line
constexpr double kAtLight_m = 4.0;      // more than is driven in a step of the search
constexpr double kLeastWay_m = 0.01, kLightAhead_m = 60.0;

}  // namespace

void block_light(const LightAhead& ahead, double start_s, int steps, bool can_stop,
                 StGraph& occupancy) {
  if (ahead.line_m <= 0.0) return;
  for (int k = 0; k <= steps; ++k) {
    const LightColour colour = colour_at(ahead.light, start_s + StGraph::kStep_s * k);
    if (colour == LightColour::green || (colour == LightColour::yellow && !can_stop)) continue;
    occupancy.block(k, std::max(kLeastWay_m, ahead.line_m - kBeforeLight_m),
                    ahead.line_m + kAtLight_m);
  }
}

std::optional<std::string> why_light_stops(std::span<const LightAhead> lights, double t_s) {
  for (const LightAhead& ahead : lights) {
    const LightColour colour = colour_at(ahead.light, t_s);
    const bool is_near = ahead.line_m > 0.0 && ahead.line_m <= kLightAhead_m;
    if (!is_near || colour == LightColour::green) continue;
    return fmt::format("{} is {}, {:.1f} m ahead", ahead.place.name,
                       colour == LightColour::red ? "red" : "yellow", ahead.line_m);
  }
  return std::nullopt;
}

}  // namespace roadbed::planning::behaviour
