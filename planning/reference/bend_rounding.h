#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/curves/quintic_bezier.h"
#include "roadbed/geometry/curves/smooth_curve.h"
#include "roadbed/geometry/motion/vehicle_shape.h"

namespace roadbed::planning::inline reference {

/// A stretch of a curve that a vehicle cannot follow, and where another one may replace it.
struct BendQuestion {
  const geometry::SmoothCurve& curve;
  double from_s_m, to_s_m;     ///< the stretch
  double least_s_m, most_s_m;  ///< where what replaces it begins at the earliest and ends at last
  /// How far a place that is beside a station, about, is outside of where the body may be; negative
  /// inside.
  std::function<double(const Eigen::Vector2d& in_map, double near_s_m)> outside_m;
  /// By how much the body may be outside; the next one where there is nothing for those before.
  std::vector<double> steps_m;
};

/// A quintic Bézier curve between two stations of the curve that it replaces in between.
struct RoundedBend {
  double from_s_m, to_s_m;
  geometry::QuinticBezier curve;
  double outside_m;  ///< at most, of the body
};

/// The curve, or why there is none.
struct BendChoice {
  std::optional<RoundedBend> bend;
  std::string reason;
};

/// Rounds a bend as `choose_corner_gaps` rounds a corner of way-points, between legs that may be
/// curved [paper eq. 6–11; at both ends it meets position, heading and curvature]: of all curves of
/// a grid of lengths and gaps that can be steered, with a tenth of the curvature in reserve and at
/// walking speed, the one of least curvature rate whose swept body is outside by no more than the
/// first step for which there is one.
BendChoice round_bend(const BendQuestion& question, const geometry::VehicleShape& vehicle);

}  // namespace roadbed::planning::reference
