#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "roadbed/tools/files/vehicle_json.h"

namespace roadbed::tools::inline files {

/// How vehicles are named, for help texts.
inline constexpr const char* kVehicleSyntax =
    "vehicle.json, Autoware's vehicle_info.param.yaml, or commonroad:1 to commonroad:4";

/// Whether a text begins as the name of a vehicle does, and so is no file.
bool is_vehicle_name(std::string_view text);

/// A vehicle of CommonRoad's, where the text is such a name; none of another text.
/// @throws InputError if there is no such vehicle.
std::optional<Vehicle> named_vehicle(const std::string& text);

/// What such a name stands for, in bytes that can be hashed: its measures.
std::string measures_text(const geometry::VehicleShape& shape);

/// Reads what `--vehicle` names: a vehicle of CommonRoad's; or a file, told by content: a JSON
/// object as vehicle_json.h tells, or Autoware's parameters.
/// @throws InputError naming key or line.
Vehicle read_vehicle(const std::filesystem::path& file);

/// The same from bytes of a file; `name` stands for the file in messages.
Vehicle parse_vehicle(std::string_view bytes, const std::string& name);

/// The rectangle alone, for what plans and drives.
/// @throws InputError as well if the vehicle is more than that.
geometry::VehicleShape read_vehicle_shape(const std::filesystem::path& file);

/// A vehicle from Autoware's `vehicle_info.param.yaml`: `/**: ros__parameters:` and below it
/// wheel_base, wheel_tread, front_overhang, rear_overhang, left_overhang, right_overhang,
/// vehicle_height and max_steer_angle, in metres and radians; others are passed over. Autoware
/// measures overhangs from the wheels' centres, on both axles. The body is as wide as tread and
/// side overhangs together; these have to be equal, as a VehicleShape lies evenly about its axis.
/// Steering turns as fast as the default vehicle's, which Autoware does not say here.
///
/// Of YAML it takes nested mappings of plain keys and scalars, with comments, and refuses all else
/// by its line: the parameters are flat numbers, and a library that reads all of YAML (anchors that
/// multiply, tags, nesting without bound) would be one more that every start pays for.
/// @throws InputError with the line.
Vehicle parse_autoware_vehicle(std::string_view bytes, const std::string& name);

}  // namespace roadbed::tools::files
