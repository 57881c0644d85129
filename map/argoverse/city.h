#pragma once

#include <string_view>

#include "roadbed/map/elements/map_content.h"

namespace roadbed::map::argoverse {

/// What the name of a map file says, as `log_map_archive_LOG____PIT_city_57819.json`, put into the
/// head: `log_id`, `city`, and for a city of the data set the CRS with the offset of its
/// coordinates. The cities' origins are those that the data set's `av2` package gives.
void add_city(std::string_view file_name, MapHead& head);

}  // namespace roadbed::map::argoverse
