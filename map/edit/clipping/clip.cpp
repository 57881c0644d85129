#include "roadbed/map/edit/clipping/clip.h"

#include <utility>

#include "roadbed/map/edit/refuse_format.h"
#include "roadbed/map/load_map.h"

namespace roadbed::map::inline edit::inline clipping {

Edited clip(std::string bytes, const std::string& name, const Region& region,
            const ClipOptions& options) {
  MapBytes map = map_bytes(std::move(bytes), name);
  if (map.format.name == "OpenDRIVE") {
    return clip_open_drive(std::move(map.bytes), name, region, options);
  }
  if (map.format.name == "Lanelet2") {
    return clip_lanelet2(std::move(map.bytes), name, region, options);
  }
  if (map.format.name == "CommonRoad") {
    return clip_common_road(std::move(map.bytes), name, region, options);
  }
  refuse_format(map.format, name, "OpenDRIVE, Lanelet2 or CommonRoad");
}

}  // namespace roadbed::map::edit::clipping
