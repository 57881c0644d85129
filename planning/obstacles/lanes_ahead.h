#pragma once

#include <optional>
#include <vector>

#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline obstacles {

/// Lanes that follow on each other, from a station of the first one on.
struct LanesAhead {
  std::vector<map::LaneId> lanes;
  double from_s_m = 0.0;
};

/// By how much a lane turns from its start to its end, whichever way [rad].
double turned_along_rad(const map::Lane& lane);

/// Their centres as one line; joints that are wider than rounding stay.
geometry::Polyline centre_of(const map::RoadMap& road_map, const LanesAhead& ahead);

/// On such a line, which goes on straight past its ends.
geometry::Pose2 pose_on(const geometry::Polyline& way, double s_m);

/// All ways on along drivable lanes, each at least `length_m` long unless its lanes end before;
/// those that turn least first. Of more than `most` the first are given, by that order at each
/// fork.
std::vector<LanesAhead> ways_ahead(const map::RoadMap& road_map, const map::LanePlace& from,
                                   double length_m, std::size_t most);

/// Of the drivable lanes that follow on a lane, the one that turns least (of equal ones the first).
std::optional<map::LaneId> straightest(const map::RoadMap& road_map, map::LaneId from);

/// Centres of the lanes from a place on, at least `length_m` long unless the lanes end before;
/// where lanes part, along the one that turns least (of equal ones the first).
geometry::Polyline straight_on(const map::RoadMap& road_map, const map::LanePlace& from,
                               double length_m);

}  // namespace roadbed::planning::obstacles
