#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/curves/quintic_bezier.h"
#include "roadbed/geometry/motion/vehicle_shape.h"

namespace roadbed::planning::inline reference {

/// What a corner is rounded for: the gentlest curve whose swept vehicle stays within `half_width_m`
/// of the segments, and that can be steered at the speed (choose_corner_gaps).
struct CornerDriving {
  geometry::VehicleShape vehicle;
  double speed_mps = 0.0;
  double half_width_m = 0.0;
};

/// A dense path through way-points, and which of them it goes through.
struct WayPointPath {
  std::vector<Eigen::Vector2d> points;      ///< at most `step_m` apart
  std::vector<Eigen::Vector2d> way_points;  ///< on the path: all but repeated ones and corners
  /// Corners that cannot be driven as asked, and what was done instead; a line of text for each.
  std::vector<std::string> notes;
  /// Where a spline is farthest from the straight lines between its way-points, and how far: few
  /// way-points in a turn leave it free to swing out.
  Eigen::Vector2d swing_at{0, 0};
  double largest_swing_m = 0.0;
};

/// Cubic splines through the way-points, measured by arc length [paper eq. 1–5], with quintic
/// Bézier curves in place of corners [eq. 6–11]. A corner is a way-point where the path turns by
/// 30° or more at once: its neighbours turn by less than half of that, or are 10 m away at least.
/// Its curve takes up to 14 m of each segment, as far as the segment is straight; two corners share
/// a segment.
/// @param driving  if given, gaps are chosen for it, over up to 40 m; a corner that cannot be
/// driven
///                 at its speed is rounded for the greatest speed at which it can.
/// @throws std::invalid_argument for fewer than two distinct way-points, one that is not finite, or
///         one where the path turns back on itself (by more than 170°), as at a spike.
WayPointPath path_through(std::span<const Eigen::Vector2d> way_points, double step_m,
                          const std::optional<CornerDriving>& driving = std::nullopt);

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
