#pragma once

#include <optional>
#include <vector>

#include "roadbed/map/elements/lane.h"
#include "roadbed/map/elements/lane_graph.h"

namespace roadbed::map::inline elements {

/// A side of a lane, in driving direction.
enum class Side { left, right };

inline Side opposite(Side side) { return side == Side::left ? Side::right : Side::left; }

inline const LaneLine& border(const Lane& lane, Side side) {
  return side == Side::left ? lane.left : lane.right;
}

inline const std::vector<BorderMark>& marks(const Lane& lane, Side side) {
  return side == Side::left ? lane.left_marks : lane.right_marks;
}

inline std::optional<Neighbour>& neighbour(LaneLinks& links, Side side) {
  return side == Side::left ? links.left : links.right;
}

/// Stretches of the lane where its border runs within `most_m` of the neighbour's facing one, by
/// the lane's stations. The nearest place moves only forward: O(points of both).
std::vector<StationRange> joined_ranges(const Lane& lane, Side side, const Lane& other,
                                        bool same_direction, double most_m);

/// Whether a driver may cross the marking; of a double line the one nearer to him counts.
bool may_cross(MarkType type, bool from_right);

/// Whether the lane may be left for the neighbour by the first marking of their border: the lane's
/// own counts, else the neighbour's; without any, lanes of one direction may be changed.
bool may_change(const Lane& lane, Side side, const Lane& other, bool same_direction);

}  // namespace roadbed::map::elements
