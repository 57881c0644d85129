#pragma once

#include <string>
#include <vector>

#include "roadbed/planning/route/route.h"

namespace roadbed::planning::inline route {

/// One thing to do on a route.
struct Instruction {
  double at_m = 0.0;    ///< along the route
  std::size_t leg = 0;  ///< that begins, or in which it happens
  std::string text;     ///< "in 240 m, turn left onto Main Street": from the one before
};

/// Turns, lane changes, stops and the arrival, in order along the route.
std::vector<Instruction> instructions_for(const map::RoadMap& road_map, const Route& route);

}  // namespace roadbed::planning::route
