#pragma once

#include <filesystem>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::tools::inline audit {

/// A lane of a route, and the stations between which it is driven.
struct RouteFileLeg {
  map::LaneId lane;
  double from_s_m, to_s_m;
};

/// A route as `route --json` printed it, of the same map.
/// @throws InputError if the file is unusable, holds no route, or names a lane or a place that the
///         map does not have.
std::vector<RouteFileLeg> read_route_file(const std::filesystem::path& file,
                                          const map::RoadMap& road_map);

}  // namespace roadbed::tools::audit
