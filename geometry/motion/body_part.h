#pragma once

#include <Eigen/Core>
#include <string>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::geometry::inline motion {

/// A part of a vehicle: a rectangle or a circle in the vehicle's frame (origin at the centre of the
/// rear axle, x forward, y left), and the heights above the ground that it takes. A car without
/// more is one part; mirrors, wheels or a load are others.
///
///            left ┌────────────────┐
///        o ─▶ x   │                │    a circle is a point (rear = front, right = left)
///           right └────────────────┘    with a radius
///               rear            front
struct BodyPart {
  std::string name = "body";
  double rear_m = 0.0, front_m = 0.0;  ///< x
  double right_m = 0.0, left_m = 0.0;  ///< y
  double radius_m = 0.0;               ///< of a circle; 0: a rectangle
  double from_height_m = 0.2, to_height_m = 1.5;

  bool is_circle() const { return radius_m > 0.0; }
  double length_m() const { return front_m - rear_m; }
  double width_m() const { return left_m - right_m; }
  Eigen::Vector2d middle_in_vehicle() const {
    return {0.5 * (rear_m + front_m), 0.5 * (right_m + left_m)};
  }

  /// The rectangle, or the circle's middle as one without extent.
  Rectangle core_at(const Pose2& pose) const;

  /// The rectangle, or the square around the circle.
  Rectangle box_at(const Pose2& pose) const;

  /// Radius of the circle around its middle that holds it.
  double circumradius_m() const;

  /// Largest distance of a point of it from the rear axle's centre.
  double reach_m() const;

  /// Counter-clockwise; a circle has 32 corners, on it.
  Ring outline_at(const Pose2& pose) const;

  /// @throws std::invalid_argument if a measure is not finite, or the part is empty.
  void check() const;
};

/// The rectangle of a vehicle, from a height above the ground up to its top.
/// @throws std::invalid_argument as VehicleShape::check.
BodyPart body_of(const VehicleShape& shape, double from_height_m = 0.2);

/// Area of the rectangle, or of the square around the circle.
double box_area_m2(const BodyPart& part);

/// The part grown by a margin: a rectangle on every side, a circle all around.
BodyPart inflated(BodyPart part, double margin_m);

}  // namespace roadbed::geometry::motion
