#pragma once

#include <functional>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/tools/simulation/scenario.h"

namespace roadbed::tools::inline simulation {

/// Pose of a centre at a distance along its way, in the map.
using Way = std::function<geometry::Pose2(double distance_m)>;

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
