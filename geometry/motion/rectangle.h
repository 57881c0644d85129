#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::geometry::inline motion {

/// A rectangle in the plane.
struct Rectangle {
  Eigen::Vector2d centre{0, 0};
  Eigen::Vector2d axis{1, 0};  ///< unit vector along its length
  double half_length_m = 0.0;
  double half_width_m = 0.0;

  /// Counter-clockwise, from the rear right one.
  std::array<Eigen::Vector2d, 4> corners() const;

  /// Radius of the circle around the centre that holds it.
  double radius_m() const;
};

/// The body of a vehicle whose rear axle's centre is at `pose`.
Rectangle body_at(const Pose2& pose, const VehicleShape& shape);

/// Distance from a point to the rectangle [m], 0 inside.
double distance_m(const Rectangle& rectangle, const Eigen::Vector2d& point);

/// Distance between two rectangles [m], 0 where they touch or overlap. Exact up to rounding.
double distance_m(const Rectangle& a, const Rectangle& b);

/// The side or corner of a rectangle of a vehicle that is nearest to a thing: "front", "rear",
/// "left side", "right side", "front left corner" and so on; of a thing that overlaps it, the side
/// that its centre is nearest to.
std::string_view side_towards(const Rectangle& thing, const Rectangle& body);

}  // namespace roadbed::geometry::motion
