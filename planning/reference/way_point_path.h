#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"

namespace roadbed::planning::inline reference {

/// What a corner is rounded for: the gentlest curve whose swept vehicle stays within `half_width_m`
/// of the segments, and that can be steered at the speed (corner_gaps.h).
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

}  // namespace roadbed::planning::reference
