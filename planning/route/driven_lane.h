#pragma once

#include <optional>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/route.h"

namespace roadbed::planning::inline route {

/// A lane, and whether it is driven against its direction.
struct DrivenLane {
  map::LaneId lane;
  bool reversed = false;
  bool operator==(const DrivenLane&) const = default;
};

inline DrivenLane driven_lane(const RouteLeg& leg) { return {leg.lane, leg.reversed}; }

/// The lane beside it, driven the same way; none if there is none.
std::optional<DrivenLane> beside(const map::RoadMap& road_map, const DrivenLane& lane, bool left);

/// Lanes behind it that are driven the same way with regard to their own direction.
std::vector<DrivenLane> following(const map::RoadMap& road_map, const DrivenLane& lane);

/// A station of the map's lane as one in driving direction, or the other way round.
double mirrored_m(const map::RoadMap& road_map, const DrivenLane& lane, double s_m);

}  // namespace roadbed::planning::route
