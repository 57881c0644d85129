#pragma once

#include <string>

#include "roadbed/map/sumo/lane_lines.h"
#include "roadbed/map/sumo/traffic_lights.h"

namespace roadbed::map::sumo {

/// Nodes, with where the coordinates are. @param location  an element.
std::string nodes_text(const RoadMap& road_map, const Net& net,
                       const std::vector<TrafficLight>& lights, const std::string& location);

std::string edges_text(const RoadMap& road_map, const Net& net, const LaneLines& lines);

std::string connections_text(const RoadMap& road_map, const Net& net, const LaneLines& lines,
                             const std::vector<TrafficLight>& lights,
                             const std::vector<Prohibition>& prohibitions);

/// The lights' programs, and which connections they switch.
std::string traffic_lights_text(const RoadMap& road_map, const Net& net,
                                const std::vector<TrafficLight>& lights);

}  // namespace roadbed::map::sumo
