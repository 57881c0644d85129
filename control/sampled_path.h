#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::control {

/// A path to track, as densely sampled poses; between two of them place and heading are linear,
/// past both ends it leads straight on. Immutable.
class SampledPath {
 public:
  /// @param poses  at least two; their headings are those of the path, and need not be unwrapped.
  /// @throws std::invalid_argument if there are fewer than two, or two neighbours coincide.
  explicit SampledPath(std::vector<geometry::Pose2> poses);

  double length_m() const { return stations_m_.back(); }

  geometry::Pose2 at(double s_m) const;

  /// Station nearest to a point, of those within `window_m` of `near_s_m`: the path may come back
  /// beside itself. Negative, or beyond the length, past an end.
  double nearest_s_m(const Eigen::Vector2d& point, double near_s_m, double window_m = 10.0) const;

 private:
  std::vector<geometry::Pose2> poses_;  ///< headings unwrapped
  std::vector<double> stations_m_;
};

// The paths of the paper's two vehicle tests (Fig. 14), between straight stretches of one second
// before and three seconds after. Corners are quintic Béziers of the gentle gaps (5, 5, 4 m); where
// a speed asks for it they are made larger, so that the lateral acceleration on them stays within
// 3 m/s²: nobody turns at a crossroad at 30 m/s.

/// A right turn at a crossroad.
/// @throws std::invalid_argument if the speed is not positive, here and below.
SampledPath right_turn_path(double speed_mps);

/// Four corners to alternate sides, by 40° each, with a half one before and after.
SampledPath zig_zag_path(double speed_mps);

}  // namespace roadbed::control
