#pragma once

// Private to planning.

#include <string_view>

#include "roadbed/geometry/motion/rectangle.h"

namespace roadbed::planning::inline obstacles {

/// The side or corner of a rectangle of a vehicle that is nearest to a thing: "front", "rear",
/// "left side", "right side", "front left corner" and so on; of a thing that overlaps it, the side
/// that its centre is nearest to.
std::string_view side_towards(const geometry::Rectangle& thing, const geometry::Rectangle& body);

}  // namespace roadbed::planning::obstacles
