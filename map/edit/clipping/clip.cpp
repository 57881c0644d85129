#include "roadbed/map/edit/clipping/clip.h"

#include <utility>

#include "roadbed/map/edit/refuse_format.h"
#include "roadbed/map/load_map.h"

namespace roadbed::map::inline edit::inline clipping {

Clipper make_clipper(std::string bytes, const std::string& name, const ClipOptions& options) {
  MapBytes map = map_bytes(std::move(bytes), name);
  if (map.format.name == "OpenDRIVE")
    return open_drive_clipper(std::move(map.bytes), name, options);
  if (map.format.name == "Lanelet2") return lanelet2_clipper(std::move(map.bytes), name, options);
  if (map.format.name == "CommonRoad") {
    return common_road_clipper(std::move(map.bytes), name, options);
  }
  refuse_format(map.format, name, "OpenDRIVE, Lanelet2 or CommonRoad");
}

Edited clip(std::string bytes, const std::string& name, const Region& region,
            const ClipOptions& options) {
  MapBytes map = map_bytes(std::move(bytes), name);
  if (map.format.name == "OpenDRIVE") {  // which needs no copy where it is cut once
    return clip_open_drive(std::move(map.bytes), name, region, options);
  }
  return make_clipper(std::move(map.bytes), name, options)(region);
}

}  // namespace roadbed::map::edit::clipping
