#include "roadbed/planning/audit/check/body_outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/geometry/primitives/segment.h"

namespace roadbed::planning::inline audit {
namespace {

using Corners = BodyOutline::Corners;

// Whether an edge of `a` has all of `b` strictly on its outer side; both are counter-clockwise.
bool parts(const Corners& a, const Corners& b) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d along = a[(i + 1) % 4] - a[i];
    const auto is_outside = [&](const Eigen::Vector2d& p) {
      return along.x() * (p.y() - a[i].y()) - along.y() * (p.x() - a[i].x()) < 0.0;
    };
    if (std::all_of(b.begin(), b.end(), is_outside)) return true;
  }
  return false;
}

double corners_distance_m(const Corners& a, const Corners& b) {
  if (!parts(a, b) && !parts(b, a)) return 0.0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      least_m = std::min({least_m, geometry::distance_to_segment_m(a[i], b[k], b[(k + 1) % 4]),
                          geometry::distance_to_segment_m(b[i], a[k], a[(k + 1) % 4])});
    }
  }
  return least_m;
}

// From a point to a rectangle, 0 inside.
double to_point_m(const Corners& from, const Eigen::Vector2d& point) {
  bool is_inside = true;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d &a = from[i], &b = from[(i + 1) % 4];
    const Eigen::Vector2d along = b - a, there = point - a;
    is_inside = is_inside && along.x() * there.y() - along.y() * there.x() >= 0.0;
    least_m = std::min(least_m, geometry::distance_to_segment_m(point, a, b));
  }
  return is_inside ? 0.0 : least_m;
}

}  // namespace

double BodyOutline::Place::distance_m(const Corners& from) const {
  return radius_m > 0.0 ? std::max(0.0, to_point_m(from, corners[0]) - radius_m)
                        : corners_distance_m(corners, from);
}

BodyOutline::BodyOutline(const geometry::BodyPart& part, double margin_m)
    : rear_m_(part.rear_m),
      front_m_(part.front_m),
      right_m_(part.right_m),
      left_m_(part.left_m),
      radius_m_(part.radius_m) {
  if (radius_m_ > 0.0) {
    radius_m_ += margin_m;
    return;
  }
  rear_m_ -= margin_m;
  front_m_ += margin_m;
  right_m_ -= margin_m;
  left_m_ += margin_m;
}

BodyOutline::Place BodyOutline::at(double x_m, double y_m, double heading_rad) const {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  const auto corner = [&](double forward_m, double left_m) {
    return Eigen::Vector2d(x_m + c * forward_m - s * left_m, y_m + s * forward_m + c * left_m);
  };
  return {{corner(rear_m_, right_m_), corner(front_m_, right_m_), corner(front_m_, left_m_),
           corner(rear_m_, left_m_)},
          radius_m_};
}

double BodyOutline::reach_m() const {
  return std::hypot(std::max(std::abs(rear_m_), std::abs(front_m_)),
                    std::max(std::abs(right_m_), std::abs(left_m_))) +
         radius_m_;
}

BodyOutline::Corners BodyOutline::box_at(double x_m, double y_m, double heading_rad) const {
  BodyOutline square = *this;
  square.rear_m_ -= radius_m_;
  square.front_m_ += radius_m_;
  square.right_m_ -= radius_m_;
  square.left_m_ += radius_m_;
  return square.at(x_m, y_m, heading_rad).corners;
}

map::Box2 BodyOutline::Place::around() const {
  Eigen::Array2d least = corners[0], most = corners[0];
  for (const Eigen::Vector2d& corner : corners) {
    least = least.min(corner.array());
    most = most.max(corner.array());
  }
  return {least - radius_m, most + radius_m};
}

BodyOutline::Corners corners_of(const map::Box2& box) {
  const Eigen::Vector2d &a = box.min_in_source, &b = box.max_in_source;
  return {{a, {b.x(), a.y()}, b, {a.x(), b.y()}}};
}

}  // namespace roadbed::planning::audit
