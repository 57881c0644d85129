#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/tools/simulation/scenario.h"

namespace roadbed::tools::inline simulation {

/// Pose of a centre at a distance along its way, in the map.
using Way = std::function<geometry::Pose2(double distance_m)>;

/// Of the drivable lanes that follow on a lane, the one that turns least (of equal ones the first).
std::optional<map::LaneId> straightest(const map::RoadMap& road_map, map::LaneId from);

/// Centres of the lanes from a place on, at least `length_m` long unless the lanes end before;
/// where lanes part, along the one that turns least (of equal ones the first).
geometry::Polyline straight_on(const map::RoadMap& road_map, const map::LanePlace& from,
                               double length_m);

/// Speed at a time, linear between the given ones and constant beyond.
double wanted_speed_mps(const std::vector<TimedSpeed>& speeds, double t_s);

/// Distance driven from time 0 to `t_s`, the speed linear between its times and constant beyond.
double travelled_m(const std::vector<TimedSpeed>& speeds, double t_s);

/// Motion along a way, a point every 0.1 s from 0 to `duration_s`; rests at the way's end.
geometry::Trajectory drive_along(const Way& way, double way_length_m,
                                 const std::vector<TimedSpeed>& speeds, double duration_s);

/// Motion through timed poses in the map, the shorter way round in heading; speeds are those of the
/// straight lines between them.
geometry::Trajectory drive_through(const std::vector<TimedPose>& poses_in_map);

}  // namespace roadbed::tools::simulation
