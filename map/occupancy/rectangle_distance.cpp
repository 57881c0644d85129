#include "roadbed/map/occupancy/rectangle_distance.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace roadbed::map {
namespace {

// Distance from a point to an axis-aligned box around the origin.
double distance_to_box(const Eigen::Vector2d& point, double half_x, double half_y) {
  return std::hypot(std::max(std::abs(point.x()) - half_x, 0.0),
                    std::max(std::abs(point.y()) - half_y, 0.0));
}

// What of a convex ring lies where direction·p ≤ limit [Sutherland & Hodgman 1974].
void clip(std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& direction, double limit) {
  std::vector<Eigen::Vector2d> kept;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const double out_a = direction.dot(a) - limit, out_b = direction.dot(b) - limit;
    if (out_a <= 0.0) kept.push_back(a);
    if ((out_a < 0.0 && out_b > 0.0) || (out_a > 0.0 && out_b < 0.0)) {
      kept.push_back(a + (b - a) * (out_a / (out_a - out_b)));
    }
  }
  ring = std::move(kept);
}

double area(const std::vector<Eigen::Vector2d>& ring) {
  double twice = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

}  // namespace

Rectangle::Rectangle(const geometry::Pose2& frame_from_vehicle, const geometry::VehicleShape& shape)
    : along_(std::cos(frame_from_vehicle.heading_rad), std::sin(frame_from_vehicle.heading_rad)),
      across_(-along_.y(), along_.x()),
      half_length_(0.5 * shape.length_m),
      half_width_(0.5 * shape.width_m) {
  centre_ = frame_from_vehicle.position() + (half_length_ - shape.rear_overhang_m) * along_;
  half_extent_ = half_length_ * along_.cwiseAbs() + half_width_ * across_.cwiseAbs();
  const Eigen::Vector2d forward = half_length_ * along_, left = half_width_ * across_;
  corners_ = {centre_ - forward - left, centre_ + forward - left, centre_ + forward + left,
              centre_ - forward + left};
}

double Rectangle::distance_to_square(const Eigen::Vector2d& centre, double half_side) const {
  const Eigen::Vector2d offset = centre - centre_;
  const Eigen::Vector2d local(offset.dot(along_), offset.dot(across_));
  const double shadow = half_side * (std::abs(along_.x()) + std::abs(along_.y()));
  // Separating axes: those of the square, then those of the rectangle.
  const bool overlap = std::abs(offset.x()) <= half_side + half_extent_.x() &&
                       std::abs(offset.y()) <= half_side + half_extent_.y() &&
                       std::abs(local.x()) <= shadow + half_length_ &&
                       std::abs(local.y()) <= shadow + half_width_;
  return overlap ? 0.0 : corner_distance(offset, half_side);
}

// Two convex shapes apart are nearest at a corner of one of them.
double Rectangle::corner_distance(const Eigen::Vector2d& offset, double half_side) const {
  double least = distance_to_box(corners_[0] - centre_ - offset, half_side, half_side);
  for (std::size_t i = 1; i < 4; ++i) {
    least = std::min(least, distance_to_box(corners_[i] - centre_ - offset, half_side, half_side));
  }
  for (const double side_x : {-half_side, half_side}) {
    for (const double side_y : {-half_side, half_side}) {
      const Eigen::Vector2d corner = offset + Eigen::Vector2d(side_x, side_y);
      const Eigen::Vector2d local(corner.dot(along_), corner.dot(across_));
      least = std::min(least, distance_to_box(local, half_length_, half_width_));
    }
  }
  return least;
}

double Rectangle::overlap_with_square(const Eigen::Vector2d& centre, double half_side) const {
  const double half_diagonal = half_side * std::sqrt(2.0);
  const Eigen::Array2d local = to_local(centre).array().abs();
  const Eigen::Array2d halves(half_length_, half_width_);
  if ((local >= halves + half_diagonal).any()) return 0.0;
  if ((local <= halves - half_diagonal).all()) return 4.0 * half_side * half_side;
  std::vector<Eigen::Vector2d> ring(corners_.begin(), corners_.end());
  for (Eigen::Vector2d& corner : ring) corner -= centre;
  for (const Eigen::Vector2d& direction : {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0),
                                           Eigen::Vector2d(0, 1), Eigen::Vector2d(0, -1)}) {
    clip(ring, direction, half_side);
  }
  return area(ring);
}

}  // namespace roadbed::map
