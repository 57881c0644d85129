#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "roadbed/map/sumo/right_of_way.h"

namespace roadbed::map::sumo {

/// How long which links show what: a letter per link, "GGrr".
struct LightPhase {
  int duration_s = 0;
  std::string state;
};

/// A node where lights say who goes; links are connections.
struct TrafficLight {
  std::uint32_t node = 0;
  std::vector<std::uint32_t> connections;         ///< by link
  std::vector<std::vector<std::size_t>> signals;  ///< by link: indices of the map's
  std::vector<LightPhase> phases;
};

/// The lights of a net, each with a program. Links are those connections whose lanes a light of the
/// map speaks to: the lane that they leave, or one inside the junction. Links of the same lights,
/// or of lights with the same controllers, switch together; such groups are green together where
/// none of their links meet. In a group whose own links meet, the one that turns more waits ("g").
std::vector<TrafficLight> make_traffic_lights(const RoadMap& road_map, const Net& net,
                                              const ConnectionConflicts& conflicts);

}  // namespace roadbed::map::sumo
