#pragma once

#include "roadbed/map/elements/lane.h"

namespace roadbed::map::inline elements {

/// By how much a lane turns from its start to its end [rad], to the left greater than zero, in
/// (−π, π]; its directions there are those of chords of 1 m.
double bend_rad(const Lane& lane);

/// From this on a lane turns off; below it goes straight on [rad].
inline constexpr double kTurnsOff_rad = 0.52359877559829882;  // 30°

}  // namespace roadbed::map::elements
