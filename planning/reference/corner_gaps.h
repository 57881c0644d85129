#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/curves/quintic_bezier.h"
#include "roadbed/geometry/motion/vehicle_shape.h"

namespace roadbed::planning::inline reference {

/// A corner of two straight segments that a vehicle is to be driven round.
struct CornerQuestion {
  Eigen::Vector2d before, at, after;  ///< w1, w2, w3: the segments are before→at and at→after
  double speed_mps = 0.0;             ///< planned there
  std::vector<Eigen::Vector2d> drivable;  ///< ring of the polygon to stay in; none: anywhere
};

/// Gaps for a corner's Bézier curve, or why there are none.
struct CornerChoice {
  std::optional<geometry::CornerGaps> gaps;
  double peak_curvature_per_m = 0.0;
  double peak_rate_per_m2 = 0.0;  ///< of dκ/ds, by arc length
  std::string reason;             ///< counts per cause, if none of the gaps will do
};

/// The gaps of least curvature rate, the first two equal so that the curve joins the segments with
/// zero curvature, of all that fit the segments (up to 40 m; a grid of lengths and proportions) and
/// whose
///   - swept vehicle stays inside the drivable polygon, looked at every 0.2 m or nearer,
///   - curvature can be steered: tan δ = L κ,
///   - curvature rate can be steered at the speed: δ̇ = L v κ′ / (1 + L² κ²).
/// @throws std::invalid_argument if a segment has no length or the speed is negative or not finite.
CornerChoice choose_corner_gaps(const CornerQuestion& question,
                                const geometry::VehicleShape& vehicle);

}  // namespace roadbed::planning::reference
