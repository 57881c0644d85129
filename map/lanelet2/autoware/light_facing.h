#pragma once

#include "roadbed/map/lanelet2/autoware/rules.h"

namespace roadbed::map::lanelet2::autoware {

/// Vehicles' traffic lights that are drawn the wrong way round: a light's line runs from left to
/// right as the drivers see it who have to look at it,
///
///     left ●──────● right      the light's line
///
///     left ║  ▲   ║ right      the end of a lanelet that names the light, next to the stop line
///
/// so that it turns by less than a right angle from that end of the lanelet. Lanelets that name one
/// light and turn by more than 45° from each other are an issue of their own, as is a light that
/// faces both ways, for different regulatory elements.
void light_facing(const VectorMap& map, const validation::ValidateOptions& options,
                  validation::Report& report);

}  // namespace roadbed::map::lanelet2::autoware
