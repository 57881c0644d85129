#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

struct MapDiffOptions {
  /// A lane whose borders moved less is not said to have moved [m]. Borders are sampled with an
  /// error of their own (LoadOptions::max_error_m).
  double tolerance_m = 1e-3;
};

/// One thing that differs between two versions of a map.
struct MapChange {
  enum class Kind { added, removed, changed };
  Kind kind = Kind::changed;
  std::string theme;    ///< "map", "road", "lane", "geometry", "link", "speed_limit", "signal", …
  std::string element;  ///< as users name it: a lane's name, the source's id, "1/0/-1 to 2/0/-1"
  std::vector<std::string> facets;  ///< what of it changed: "type", "place", …; in a fixed order
  double moved_m = 0.0;             ///< of "geometry": how far its borders moved at most
  std::optional<Eigen::Vector2d> in_source;  ///< where that is
};

/// "added", "removed", "changed"
std::string_view to_string(MapChange::Kind kind);

/// What changed from one version to another, by theme and then in the order of the map's lists.
/// Things are the same if they have the same name (lanes) or source id and road; of several with
/// one id, the first is compared with the first. Coordinates are compared as the source has them,
/// whatever the maps' origins, and numbers but those of borders to a millionth. Remarks of the
/// import are not compared.
std::vector<MapChange> diff(const RoadMap& before, const RoadMap& after,
                            const MapDiffOptions& options = {});

}  // namespace roadbed::map::derived
