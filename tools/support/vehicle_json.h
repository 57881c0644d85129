#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "roadbed/geometry/vehicle_shape.h"

namespace roadbed::tools {

/// Reads a vehicle: one JSON object with the members of VehicleShape as keys, every one optional,
/// with its default. An unknown key is an error, so that a misspelt one is not lost.
/// @throws InputError naming the key, or the byte where the text is not JSON.
geometry::VehicleShape read_vehicle_json(const std::filesystem::path& file);

/// The same from bytes; `name` stands for the file in messages.
geometry::VehicleShape parse_vehicle_json(std::string_view bytes, const std::string& name);

}  // namespace roadbed::tools
