#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::opendrive {

struct OpenDriveOptions {
  std::string crs;          ///< of the map's raw coordinates, empty if unknown
  CrsOffset offset_in_crs;  ///< of these in it
  int minor = 8;            ///< revision 1.4 to 1.8
  int threads = 1;          ///< the bytes are the same for any number
};

/// An OpenDRIVE file, and how near it is to the map.
struct OpenDriveFile {
  std::string bytes;
  double largest_error_m = 0.0;                           ///< of a lane's border, in plan
  double largest_height_error_m = 0.0;                    ///< of a border's elevation
  std::vector<std::pair<std::string, std::size_t>> lost;  ///< what is not in it, and how many
  std::vector<std::string> notes;                         ///< lines for the user
};

/// The map as OpenDRIVE: lanes side by side are a road, its reference line made of clothoids, arcs
/// and lines, its borders within a centimetre of the map's; links and junctions; markings, speeds
/// and users; signals, stop lines, crosswalks and other objects. x and y stay the source's own. A
/// pure function: same map, same bytes.
/// @throws std::invalid_argument if the revision is none of 1.4 to 1.8.
/// @throws InputError if more lanes lead into one another in one place than a file can hold.
OpenDriveFile write_open_drive(const RoadMap& road_map, const OpenDriveOptions& options);

/// Elements of an OpenDRIVE file that are read, but that no file of its map has, and how many.
/// @throws InputError if the bytes are no XML.
std::vector<std::pair<std::string, std::size_t>> unwritten_elements(const std::string& source);

}  // namespace roadbed::map::opendrive
