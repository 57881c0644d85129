#pragma once

#include <optional>
#include <span>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline rules {

/// The limit of a lane at a place of it; infinite where there is none.
struct LaneLimit {
  double limit_mps;
  const map::Lane* lane;
};

/// Of the lanes at a place that somebody is along, turned from them by less than a right angle, the
/// one that lets drive fastest; where he is against all of them, of all. None if the map says no
/// limit of any of them.
std::optional<LaneLimit> limit_along(const map::RoadMap& road_map,
                                     std::span<const map::LaneMatch> lanes, double heading_rad);

/// The limit at each row of a drive, of the lanes that its rear axle is in.
std::vector<std::optional<LaneLimit>> limits_along(const map::RoadMap& road_map,
                                                   const geometry::Trajectory& drive_in_source);

}  // namespace roadbed::planning::rules
