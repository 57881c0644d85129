#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// A vector map for Autoware, and what could not be said in it.
struct AutowareFiles {
  std::string vector_map;      ///< lanelet2_map.osm
  std::string projector_info;  ///< map_projector_info.yaml, to lie beside it
  std::vector<std::pair<std::string, std::size_t>> lost;
  std::vector<std::string> notes;  ///< a line each, for the user
};

struct AutowareOptions {
  std::string crs;          ///< of the map's raw coordinates; empty if unknown
  CrsOffset offset_in_crs;  ///< of the same
  /// The Lanelet2 file that the map was read from, if there is one: all of it is kept.
  std::optional<std::string> source;
};

/// The map as Autoware's vector map: the lanelets that it knows with the tags, areas and regulatory
/// elements that it asks for, as far as the source has what they need, in the frame of an MGRS
/// square. `roadbed validate --profile autoware` says what is still missing.
/// Cost: the file is made and looked at three times.
AutowareFiles write_autoware(const RoadMap& road_map, const AutowareOptions& options);

}  // namespace roadbed::map::lanelet2
