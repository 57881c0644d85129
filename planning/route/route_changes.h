#pragma once

#include <cstddef>
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

/// The two lanes beside each other in one of the lane groups that a lane change takes.
struct ChangePart {
  std::size_t leg = 0;  ///< of the route, on one of both lanes
  DrivenLane from, to;
  double offset_m = 0.0;  ///< station of the left leg's lane at which the lane group begins
};

/// The window of the change by which a leg is left, by stations in driving direction.
/// @pre there is one.
map::StationRange driven_window(const map::RoadMap& road_map, const RouteLeg& leg);

/// Lane groups of the change by which a leg is left: its own first, then those before it, back from
/// there, then those behind it. Stations are in driving direction. Empty for a leg that is left
/// otherwise.
std::vector<ChangePart> parts_of_change(const map::RoadMap& road_map, const Route& route,
                                        std::size_t leg);

}  // namespace roadbed::planning::route
