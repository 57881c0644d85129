#pragma once

#include <span>
#include <string>

#include "roadbed/map/derived/map_diff.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/page/map_page.h"

namespace roadbed::map::inline page {

/// The page of the newer of two maps, with a list to walk through of what changed, and over the map
/// what was added, removed and changed, and where borders, signals and objects were before.
/// @param changes  of `diff(before, after)`.
/// @param options  its remarks and overlays are not looked at.
std::string write_diff_page(const RoadMap& before, const RoadMap& after,
                            std::span<const MapChange> changes, MapPageOptions options = {});

}  // namespace roadbed::map::page
