#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// Where the map is.
struct Lanelet2Options {
  std::string crs;          ///< empty if unknown
  CrsOffset offset_in_crs;  ///< of the map's raw coordinates
};

/// A Lanelet2 file, and what could not be said in it.
struct Lanelet2File {
  std::string bytes;
  std::vector<std::string> notes;                         ///< a line each, for the user
  std::vector<std::pair<std::string, std::size_t>> lost;  ///< what is not in it, and how many
};

/// The map as Lanelet2: borders shared by neighbours, end nodes by successors, so that its routing
/// graph is that of the map; lane changes by line types, where those do not say it by lane_change
/// tags; nodes with lat/lon, elevation, and local_x/local_y in the map's own coordinates. Lanes
/// that nobody may use (medians, curbs) are left out.
/// @throws InputError if the CRS is unknown or no transverse Mercator one.
Lanelet2File write_lanelet2(const RoadMap& road_map, const Lanelet2Options& options);

/// The same, where the map says itself where it is.
Lanelet2File write_lanelet2(const RoadMap& road_map);

}  // namespace roadbed::map::lanelet2
