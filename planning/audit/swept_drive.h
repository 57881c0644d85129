#pragma once

#include <functional>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::planning::inline audit {

struct SweepOptions {
  double speed_mps = 10.0;
  double offset_m = 0.0;  ///< of the rear axle from the line, positive to the left
  double step_m = 0.5;    ///< of the line between samples; the last step is shortened
};

/// A drive along a line from station 0 to `length_m`, at constant speed of the station: the rear
/// axle keeps its offset and the body the line's direction.
/// @param line  pose of a line at a station.
/// @throws std::invalid_argument if a number is not finite, or speed, step or length not positive.
geometry::Trajectory swept_along(const std::function<geometry::Pose2(double s_m)>& line,
                                 double length_m, const SweepOptions& options = {});

}  // namespace roadbed::planning::audit
