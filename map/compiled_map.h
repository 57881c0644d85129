#pragma once

#include <string>
#include <string_view>

#include "roadbed/map/road_map.h"

namespace roadbed::map {

/// The compiled form of a map (`.rbm`): everything of it, ready to use, with a checksum.
std::string write_compiled_map(const RoadMap& road_map);

/// Whether the bytes begin as a compiled map does.
bool is_compiled_map(std::string_view bytes);

/// @throws InputError if the bytes are cut, changed or of another version.
RoadMap read_compiled_map(std::string_view bytes, const std::string& name);

}  // namespace roadbed::map
