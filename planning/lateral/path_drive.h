#pragma once

#include <functional>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/lateral/candidates.h"
#include "roadbed/planning/lateral/planned_speed.h"
#include "roadbed/planning/reference/line_view.h"

namespace roadbed::planning::inline lateral {

/// A path beside a line: d, d′ and d″ at a station of it; may be empty.
using LateralPath = std::function<LateralState(double s_m)>;

/// A path, and where and when it is driven from.
struct DrivenPath {
  const LineView& line;
  const LateralPath& path;
  const geometry::VehicleShape& vehicle;
  double start_s_m = 0.0, start_t_s = 0.0;
};

/// The drive along a path at a constant deceleration; from its stop it stands for `until_s` after
/// the start, or longer. A sample every 0.05 s.
geometry::Trajectory stopping_drive(const DrivenPath& driven, double speed_mps,
                                    double deceleration_mps2, double until_s);

/// Between samples of passing_drive(), along the line.
inline constexpr double kPassStep_m = 1.0;

/// The drive along a path up to a station, at a planned speed by the length driven; its last sample
/// is the first one over `until_s` after the start. A sample every kPassStep_m of the line.
geometry::Trajectory passing_drive(const DrivenPath& driven, const PlannedSpeed& speed,
                                   double end_s_m, double until_s);

}  // namespace roadbed::planning::lateral
