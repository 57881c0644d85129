#pragma once

#include <optional>
#include <vector>

#include "roadbed/map/elements/lane.h"
#include "roadbed/map/elements/lane_graph.h"
#include "roadbed/map/lane_table/table.h"

namespace roadbed::map::lane_table {

struct Borders {
  Line3 left, right;
  Line3 centre;  ///< empty, or with a point for each of theirs
};

/// Borders half a width to either side of a centreline: a vertex for each of its, on the bisector
/// of its corner, at most two widths away. None if the line has no length.
std::optional<Borders> borders_beside(const Line3& centre, double width_m);

/// Borders of a lane that is drawn as an outline: the two edges of it that lie most across the
/// driving direction, one at either end, are where it begins and ends.
///
///         ┌───────────────┐
///     ──▶ │ begins   ends │ ──▶
///         └───────────────┘
///
/// @param heading_rad  clockwise from north.
/// @returns none if no edge is across it.
std::optional<Borders> borders_of_ring(const Line3& ring, double heading_rad);

/// Links lanes of which one begins where the other ends, with both borders, within `most_m`.
void link_ends(const std::vector<Lane>& lanes, double most_m, std::vector<LaneLinks>& links);

/// Makes neighbours of lanes whose facing borders begin and end within `most_m` of each other.
void link_beside(const std::vector<Lane>& lanes, double most_m, std::vector<LaneLinks>& links);

}  // namespace roadbed::map::lane_table
