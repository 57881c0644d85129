#pragma once

// Private to planning/audit: part of the check of certificates, which shares nothing with the
// audit, so that a fault there is not a fault here.

#include <Eigen/Core>
#include <array>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"

namespace roadbed::planning::inline audit {

/// A part of a vehicle, rectangle or circle, with a margin all around; poses are those of the rear
/// axle's centre.
class BodyOutline {
 public:
  BodyOutline(const geometry::BodyPart& part, double margin_m);

  using Corners = std::array<Eigen::Vector2d, 4>;  ///< counter-clockwise

  /// Where it is: a circle's four corners are its middle.
  struct Place {
    Corners corners;
    double radius_m;

    /// Distance from a rectangle, given by its corners; 0 where they meet.
    double distance_m(const Corners& from) const;

    /// With sides along x and y, around all of it.
    map::Box2 around() const;
  };
  Place at(double x_m, double y_m, double heading_rad) const;
  /// The rectangle, or the square around the circle.
  Corners box_at(double x_m, double y_m, double heading_rad) const;
  double reach_m() const;  ///< from the rear axle's centre to the farthest point

 private:
  double rear_m_, front_m_, right_m_, left_m_, radius_m_;
};

/// Of a box, counter-clockwise.
BodyOutline::Corners corners_of(const map::Box2& box);

}  // namespace roadbed::planning::audit
