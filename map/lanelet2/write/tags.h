#pragma once

#include <optional>

#include "roadbed/map/elements/attributes.h"
#include "roadbed/map/elements/border_mark.h"
#include "roadbed/map/elements/lane.h"

namespace roadbed::map::lanelet2 {

/// Whether a lane has a place in a Lanelet2 map: somebody may use it, or it is a shoulder.
bool is_writable(const Lane& lane);

/// Adds `participant:*` tags that name these users.
void add_participants(const Participants& users, Attributes& tags);

/// The tags of a lanelet, `type` first: its own where the map comes from a Lanelet2 file, else what
/// its type, users, directions and limit say.
Attributes lanelet_tags(const Lane& lane, bool from_lanelet2);

/// What the lanes beside a line say of crossing it, seen in the line's direction; none: no lane
/// asks.
struct CrossingWish {
  std::optional<bool> to_left, to_right;
};

/// The tags of a border: the type that its marking has, and lane_change tags where that type would
/// not allow what it should.
/// @param mark  in the line's direction, none if unknown.
Attributes border_tags(const std::optional<BorderMark>& mark, const CrossingWish& wish);

/// The same marking seen against its direction.
BorderMark turned(BorderMark mark);

}  // namespace roadbed::map::lanelet2
