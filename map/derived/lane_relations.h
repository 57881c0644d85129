#pragma once

#include <optional>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// Of each lane the nearest one beside it that runs against it, across any lanes of its own
/// direction that lie between; none on a one-way road. O(lanes).
std::vector<std::optional<LaneId>> opposite_lanes(const LaneGraph& graph);

/// Lanes that lead into one lane.
struct Merge {
  LaneId into;
  std::vector<LaneId> from;  ///< two or more, in order of id
};

/// Every place where several lanes share a successor, by that successor. O(lanes + links).
std::vector<Merge> merges(const LaneGraph& graph);

/// Other lanes that lead into a successor of this one: those to give way to, or to zip with.
/// In order of id.
std::vector<LaneId> merging_lanes(const LaneGraph& graph, LaneId lane);

/// Whether two lanes begin in opposite directions: further apart than 138 degrees.
bool begin_oppositely(const RoadMap& road_map, LaneId a, LaneId b);

/// Whether a lane crosses one of oncoming traffic, to which who turns along it gives way. Looks at
/// the lanes near it.
bool crosses_oncoming(const RoadMap& road_map, LaneId lane);

/// Whether the map drives on the left: of OpenDRIVE most lanes on the left of their roads lead
/// along them (8.2, `rule`); elsewhere more opposite lanes have each other to their right than to
/// their left. O(lanes).
bool drives_on_the_left(const RoadMap& road_map);

}  // namespace roadbed::map::derived
