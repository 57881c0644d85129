#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// Where a ray passes a lane.
struct LaneOnRay {
  LaneId lane;
  double from_m = 0.0, to_m = 0.0;  ///< distances along the ray between which it is in the lane
};

/// Lanes whose polygon meets a box (touching counts), in order of id.
std::vector<LaneId> lanes_in_box(const RoadMap& road_map, const geometry::Box& box_in_map);

/// Lanes that a straight way of `length_m` from a point passes, by `from_m`, then by id; a lane
/// that it leaves and enters again is there once for each passage.
std::vector<LaneOnRay> lanes_along_ray(const RoadMap& road_map, const Eigen::Vector2d& from_in_map,
                                       double heading_rad, double length_m);

}  // namespace roadbed::map::derived
