#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline files {

class JsonNode;

/// A vehicle as its file tells it: the rectangle that is planned and driven with, and what an audit
/// looks at besides.
struct Vehicle {
  geometry::VehicleShape shape;
  std::vector<geometry::BodyPart> circles;  ///< cover the body in place of the rectangle, if any
  std::vector<geometry::BodyPart> more;     ///< mirrors and other parts

  /// Body and all other parts. The rectangle begins `from_height_m` above the ground, and so do
  /// circles that do not say where they begin.
  /// @throws InputError if a part would be empty.
  std::vector<geometry::BodyPart> parts(double from_height_m) const;
};

/// Less is no height of a part, but a mistake.
inline constexpr double kLeastHeight_m = 1e-3;

/// Whether heights are apart by that; a rounding below is let pass.
bool is_height_of_part(double from_m, double to_m);

/// The name of a part: one line of 1 to 60 bytes.
/// @throws InputError otherwise.
std::string read_part_name(const JsonNode& node);

/// Reads a vehicle: one JSON object with the members of VehicleShape as keys, every one optional,
/// with its default. An unknown key is an error, so that a misspelt one is not lost. For audits
/// there are also, each optional,
///
///     "mirrors": {"beyond_m": 0.2, "rear_m": 1.7, "front_m": 1.9,
///                 "from_height_m": 0.9, "to_height_m": 1.2}
///     "circles": [{"x_m": 0.4, "y_m": 0, "radius_m": 1.1}, …]
///     "parts": [{"name": "load", "rear_m": -1.2, "front_m": 2.4, "right_m": -1.1, "left_m": 1.1,
///                "from_height_m": 1.2, "to_height_m": 2.1}, …]
///
/// in the vehicle's frame and above the ground: two boxes that stick out beyond the body's sides,
/// circles that cover the body in place of its rectangle (heights optional), and any other parts.
/// @param name  stands for the file in messages.
/// @throws InputError naming the key, or the byte where the text is not JSON.
Vehicle parse_vehicle_json(std::string_view bytes, const std::string& name);

/// The same from a member of another document.
Vehicle vehicle_in(const JsonNode& node);

/// The rectangle alone, for what plans and drives.
/// @throws InputError as well if the vehicle is more than that.
geometry::VehicleShape vehicle_shape_in(const JsonNode& node);

}  // namespace roadbed::tools::files
