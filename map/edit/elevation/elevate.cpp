#include "roadbed/map/edit/elevation/elevate.h"

#include <utility>

#include "roadbed/map/edit/refuse_format.h"
#include "roadbed/map/load_map.h"

namespace roadbed::map::inline edit::inline elevation {

Edited elevate(std::string bytes, const std::string& name, const GroundHeights& ground) {
  MapBytes map = map_bytes(std::move(bytes), name);
  if (map.format.name == "OpenDRIVE") return elevate_open_drive(std::move(map.bytes), name, ground);
  if (map.format.name == "Lanelet2") return elevate_lanelet2(std::move(map.bytes), name, ground);
  if (map.format.name == "CommonRoad") {
    return elevate_common_road(std::move(map.bytes), name, ground);
  }
  refuse_format(map.format, name, "OpenDRIVE, Lanelet2 or CommonRoad");
}

}  // namespace roadbed::map::edit::elevation
