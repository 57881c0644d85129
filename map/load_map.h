#pragma once

#include <filesystem>
#include <string>

#include "roadbed/map/model/load_options.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map {

/// Reads any readable map, a compiled one too; the format is told by content.
/// @throws InputError if the file is missing, unreadable, of no known format or unusable.
RoadMap load_map(const std::filesystem::path& file, const LoadOptions& options = {});

/// The same from bytes; `name` stands for the file in messages.
RoadMap parse_map(std::string bytes, const std::string& name, const LoadOptions& options = {});

}  // namespace roadbed::map
