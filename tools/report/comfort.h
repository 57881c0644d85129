#pragma once

#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

/// The largest value of a drive, and the first time of it.
struct Worst {
  double value;
  double at_s;
};

/// A check that the largest value is no more than a bound.
ReportCheck at_most(std::string name, const Worst& worst, double bound, std::string unit,
                    std::string bound_from);

/// Accelerations, braking and yaw rate of a drive within what passengers bear (metrics.h).
/// @pre the drive is not empty
std::vector<ReportCheck> comfort_checks(const geometry::Trajectory& drive);

}  // namespace roadbed::tools::report
