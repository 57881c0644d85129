#pragma once

#include "roadbed/geometry/motion/trajectory.h"

namespace roadbed::tools::inline report {

/// A drive with what its headings and speeds say of its dynamics, for files that do not:
/// acceleration and yaw rate are slopes of least-squares lines over half a second before and
/// behind, or to the next rows where these are farther apart; curvature is yaw rate by the line's
/// speed, 0 below 0.5 m/s, and the front wheels are turned as it asks for without slip. A drive
/// that tells any of them stays as it is. O(rows · rows in a second).
geometry::Trajectory with_dynamics(const geometry::Trajectory& drive, double wheelbase_m);

}  // namespace roadbed::tools::report
