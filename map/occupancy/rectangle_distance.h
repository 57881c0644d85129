#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <array>

#include "roadbed/geometry/pose2.h"
#include "roadbed/geometry/vehicle_shape.h"

namespace roadbed::map {

/// A vehicle's rectangle at a pose: centre, directions of its sides, half their lengths.
class Rectangle {
 public:
  Rectangle(const geometry::Pose2& frame_from_vehicle, const geometry::VehicleShape& shape);

  const Eigen::Vector2d& centre() const { return centre_; }
  const std::array<Eigen::Vector2d, 4>& corners() const { return corners_; }
  const Eigen::Vector2d& half_extent() const { return half_extent_; }  ///< of its bounding box
  double area_m2() const { return 4.0 * half_length_ * half_width_; }
  double half_length() const { return half_length_; }
  double half_width() const { return half_width_; }

  /// A point in the rectangle's own frame: x along it, origin at its centre.
  Eigen::Vector2d to_local(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d offset = point - centre_;
    return {offset.dot(along_), offset.dot(across_)};
  }

  /// Exact distance to an axis-aligned square, 0 on overlap or touch.
  double distance_to_square(const Eigen::Vector2d& centre, double half_side) const;

  /// Area of the part that lies in an axis-aligned square.
  double overlap_with_square(const Eigen::Vector2d& centre, double half_side) const;

 private:
  double corner_distance(const Eigen::Vector2d& offset, double half_side) const;

  Eigen::Vector2d centre_, along_, across_, half_extent_;
  double half_length_, half_width_;
  std::array<Eigen::Vector2d, 4> corners_;
};

}  // namespace roadbed::map
