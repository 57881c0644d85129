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
  OnLine peak_curvature_per_m;        ///< greatest |κ|
  OnLine peak_curvature_rate_per_m2;  ///< greatest |κ′|
  OnLine slowest_mps;                 ///< least speed that the steering rate asks for
  std::vector<LineFault> bends;       ///< that cannot be steered, see below
  std::vector<LineFault> leaves;      ///< the body leaves the road
};

/// Length of all of them together [m], over 0 if there is any.
double length_of(const std::vector<LineFault>& faults);

/// A line of text for each.
std::vector<std::string> notes_on(const std::vector<LineFault>& faults);

/// From station 0 to another one, every 0.25 m. A bend cannot be steered where it asks for more
/// than the drivable curvature, or, at walking speed, for more than the steering rate.
/// @param on_road  whether a place in the map is on the road; empty: everything is.
LineDriving driving_along(const LineView& line, double end_s_m,
                          const geometry::VehicleShape& vehicle,
                          const std::function<bool(const Eigen::Vector2d&)>& on_road);

/// Speed below which everybody can be asked to take a bend [m/s].
inline constexpr double kWalkingSpeed_mps = 1.4;

/// Curvature that a line may ask for [1/m]: 0.9 of tan δ_max / L, so that there is some left to
/// correct errors and to drive beside the line.
double drivable_curvature_per_m(const geometry::VehicleShape& vehicle);

/// Speed at which the wheels turn as fast as they can where κ′ is as given: δ̇ = L v κ′ / (1 + L²
/// κ²).
double steerable_mps(double curvature_per_m, double rate_per_m2,
                     const geometry::VehicleShape& vehicle);

/// Places on the outline of the body, half a metre apart at most, in the vehicle's frame.
std::vector<Eigen::Vector2d> body_outline(const geometry::VehicleShape& vehicle);

}  // namespace roadbed::planning::reference
