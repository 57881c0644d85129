#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace roadbed::planning {

/// A dense path through way-points, and which of them it goes through.
struct WayPointPath {
  std::vector<Eigen::Vector2d> points;      ///< at most `step_m` apart
  std::vector<Eigen::Vector2d> way_points;  ///< on the path: all but repeated ones and corners
};

/// Cubic splines through the way-points, measured by arc length [paper eq. 1–5], with quintic
/// Bézier curves in place of corners [eq. 6–11]. A corner is a way-point where the path turns by
/// 30° or more at once: its neighbours turn by less than half of that, or are 10 m away at least.
/// Its curve takes up to 14 m of each leg, as far as the leg is straight; two corners share a leg.
/// @throws std::invalid_argument for fewer than two distinct way-points, or one that is not finite.
WayPointPath path_through(std::span<const Eigen::Vector2d> way_points, double step_m);

}  // namespace roadbed::planning
