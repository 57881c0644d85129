#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::geometry::inline motion {

/// A car-like vehicle. Its frame: origin at the centre of the rear axle, x forward, y left.
///
///      ┌──────────────────────────┐
///      │   o────────────────o     │ ▶ x      o: axles, wheelbase apart
///      └──────────────────────────┘
///      ◀──▶ rear overhang
///
/// The defaults are CommonRoad's vehicle 2 (BMW 320i).
struct VehicleShape {
  double length_m = 4.508;
  double width_m = 1.610;
  double rear_overhang_m = 0.8312829;
  double wheelbase_m = 2.5789128;
  double height_m = 1.5;
  double max_steering_rad = 1.066;
  double max_steering_rate_radps = 0.4;

  double front_m() const { return length_m - rear_overhang_m; }  ///< from rear axle to front bumper

  /// Rear right, front right, front left, rear left: counter-clockwise.
  std::array<Eigen::Vector2d, 4> corners_in_vehicle() const;

  /// Largest distance of a point of the body from the rear axle's centre.
  double reach_m() const;

  /// @throws std::invalid_argument naming the first length that is not positive and finite, or an
  ///         axle outside the body.
  void check() const;
};

/// Circles on the vehicle's x axis that together cover its rectangle.
struct CoveringCircles {
  std::vector<double> centres_x_m;
  double radius_m;
};

/// `count` equal circles, the smallest that cover; they stick out by radius − width/2.
/// @throws std::invalid_argument if count < 1.
CoveringCircles covering_circles(const VehicleShape& shape, int count);

}  // namespace roadbed::geometry::motion
