#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline reference {

/// A value and where on a line it is.
struct OnLine {
  double value = 0.0;
  double s_m = 0.0;
};

/// A stretch of a line that a vehicle cannot follow as it is, and why.
struct LineFault {
  double from_s_m, to_s_m;
  std::string reason;
};

/// What a line asks of a vehicle whose rear axle's centre follows it.
struct LineDriving {
  OnLine peak_curvature_per_m;           ///< greatest |κ|
  OnLine peak_curvature_rate_per_m2;     ///< greatest |κ′|
  OnLine slowest_mps;                    ///< least speed that the steering rate asks for
  std::vector<LineFault> bends, leaves;  ///< |κ| over tan δ_max / L; the body leaves the road
};

/// Length of all of them together [m], over 0 if there is any.
double length_of(const std::vector<LineFault>& faults);

/// From station 0 to another one, every 0.25 m.
/// @param on_road  whether a place in the map is on the road; empty: everything is.
LineDriving driving_along(const LineView& line, double end_s_m,
                          const geometry::VehicleShape& vehicle,
                          const std::function<bool(const Eigen::Vector2d&)>& on_road);

/// Curvature that the vehicle's steering reaches [1/m].
double greatest_curvature_per_m(const geometry::VehicleShape& vehicle);

}  // namespace roadbed::planning::reference
