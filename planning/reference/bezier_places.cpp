#include "roadbed/planning/reference/bezier_places.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/primitives/cross.h"

namespace roadbed::planning::inline reference {
namespace {

using Eigen::Vector2d;

constexpr double kPlaceStep_m = 0.2;

BezierPlace place_at(const geometry::QuinticBezier& curve, double t) {
  const Vector2d p = curve.at(t), p1 = curve.derivative(t, 1), p2 = curve.derivative(t, 2),
                 p3 = curve.derivative(t, 3);
  const double squared = p1.squaredNorm(), speed = std::sqrt(squared);
  const double turn = geometry::cross(p1, p2), curvature = turn / (squared * speed);
  // d/dt (turn / speed³), by arc length.
  const double rate =
      (geometry::cross(p1, p3) - 3.0 * turn * p1.dot(p2) / squared) / (squared * squared);
  return {{p.x(), p.y(), std::atan2(p1.y(), p1.x())}, curvature, rate};
}

}  // namespace

std::vector<BezierPlace> places_on(const geometry::QuinticBezier& curve, int count) {
  std::vector<BezierPlace> places;
  for (int i = 0; i <= count; ++i) {
    places.push_back(place_at(curve, static_cast<double>(i) / count));
  }
  return places;
}

// The parameter's speed is at most that of the control polygon's longest side, five times over.
std::vector<BezierPlace> dense_places_on(const geometry::QuinticBezier& curve, double scale) {
  const auto& control = curve.control_points();
  double longest_m = 0.0;
  for (std::size_t i = 0; i + 1 < control.size(); ++i) {
    longest_m = std::max(longest_m, (control[i + 1] - control[i]).norm());
  }
  return places_on(curve, static_cast<int>(std::ceil(5.0 * longest_m * scale / kPlaceStep_m)));
}

}  // namespace roadbed::planning::reference
