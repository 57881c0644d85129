#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::sumo {

struct SumoOptions {
  std::string name;         ///< of the files before their suffixes, for the configuration
  std::string crs;          ///< of the map's raw coordinates, empty if unknown
  CrsOffset offset_in_crs;  ///< of these in it
};

/// What netconvert makes a net of, each as a file's text.
struct SumoFiles {
  std::string nodes;           ///< .nod.xml
  std::string edges;           ///< .edg.xml
  std::string connections;     ///< .con.xml
  std::string traffic_lights;  ///< .tll.xml
  std::string configuration;   ///< .netccfg: `netconvert -c` makes the net of the four
  std::vector<std::pair<std::string, std::size_t>> lost;  ///< what is not in them, and how many
  std::vector<std::string> notes;                         ///< lines for the user
};

/// The map as SUMO's plain XML: lanes that are driven the same way beside each other are an edge,
/// lanes inside junctions are connections with their shape; speeds, users, lane changes, right of
/// way, traffic lights with a program. x and y stay the source's own. A pure function: same map,
/// same bytes.
SumoFiles write_sumo(const RoadMap& road_map, const SumoOptions& options);

}  // namespace roadbed::map::sumo
