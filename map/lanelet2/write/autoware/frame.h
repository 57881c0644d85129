#pragma once

#include <string>
#include <vector>

#include "roadbed/map/lanelet2/write/osm_map.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// Where the map's raw coordinates are.
struct SourceFrame {
  std::string crs;           ///< empty if unknown
  CrsOffset offset_in_crs;   ///< of the map's raw coordinates
  bool is_autoware = false;  ///< they are local_x and local_y of a file, and stay what they are
};

/// The coordinates of an Autoware map, and its map_projector_info.yaml. Places are those of the
/// nodes, one after the other.
struct AutowareFrame {
  OsmFrame of_file;
  std::vector<GeographicPoint> on_earth;
  std::vector<Eigen::Vector2d> local;
  std::vector<std::string> mgrs_codes;  ///< or empty
  std::string projector_info;
  std::vector<std::string> notes;
};

/// Local coordinates as Autoware's projector asks for them:
///
/// | what is known | projector | local_x, local_y |
/// |---|---|---|
/// | a system | MGRS | metres from the corner of a square of 100 km, beyond its edges too |
/// | coordinates of an Autoware map, a shift of the UTM grid | MGRS or LocalCartesianUTM | kept |
/// | none of these | Local | the source's own |
///
/// The square is that of most nodes, the zone that of their middle: a map over an edge of either
/// has one frame all the same.
AutowareFrame autoware_frame(const RoadMap& road_map, const OsmMap& osm, const SourceFrame& source);

/// The file of a map in its frame.
std::string osm_text(const OsmMap& osm, const AutowareFrame& frame);

}  // namespace roadbed::map::lanelet2
