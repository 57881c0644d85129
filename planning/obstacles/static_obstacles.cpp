#include "roadbed/planning/obstacles/static_obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace roadbed::planning::inline obstacles {
namespace {

using geometry::Rectangle;

constexpr double kMostPoints = 50'000.0;

// How many squares with this half diagonal cover a length.
double squares_along(double length_m, double gap_m) {
  return std::max(1.0, std::ceil(length_m / (gap_m * std::numbers::sqrt2)));
}

double points_for(const std::vector<Rectangle>& bodies, double gap_m) {
  double count = 0.0;
  for (const Rectangle& body : bodies) {
    count += squares_along(2.0 * body.half_length_m, gap_m) *
             squares_along(2.0 * body.half_width_m, gap_m);
  }
  return count;
}

// The centres of squares that cover the body.
void spread_points(const Rectangle& body, double gap_m, std::vector<Eigen::Vector2d>& points) {
  const Eigen::Vector2d left(-body.axis.y(), body.axis.x());
  const double along = squares_along(2.0 * body.half_length_m, gap_m);
  const double across = squares_along(2.0 * body.half_width_m, gap_m);
  for (double i = 0.5; i < along; i += 1.0) {
    for (double j = 0.5; j < across; j += 1.0) {
      points.push_back(body.centre + (2.0 * i / along - 1.0) * body.half_length_m * body.axis +
                       (2.0 * j / across - 1.0) * body.half_width_m * left);
    }
  }
}

}  // namespace

StaticObstacles::StaticObstacles(const std::vector<Obstacle>& obstacles) {
  for (const Obstacle& obstacle : obstacles) {
    if (obstacle.is_static()) bodies_.push_back(rectangle_at(obstacle, 0.0));
  }
  while (points_for(bodies_, gap_m_) >
         std::max(kMostPoints, 4.0 * static_cast<double>(bodies_.size())))
    gap_m_ *= 2.0;
  std::vector<Eigen::Vector2d> points;
  for (const Rectangle& body : bodies_) spread_points(body, gap_m_, points);
  points_ = geometry::PointIndex(points);
}

double StaticObstacles::distance_bound_m(const Eigen::Vector2d& point) const {
  const auto nearest = points_.nearest(point);
  if (!nearest) return std::numeric_limits<double>::infinity();
  return std::max(0.0, nearest->distance_m - gap_m_);
}

double StaticObstacles::distance_m(const Rectangle& rectangle) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Rectangle& body : bodies_) {
    const double at_least_m =
        (body.centre - rectangle.centre).norm() - body.radius_m() - rectangle.radius_m();
    if (at_least_m < nearest_m) {
      nearest_m = std::min(nearest_m, geometry::distance_m(rectangle, body));
    }
  }
  return nearest_m;
}

const Rectangle& StaticObstacles::nearest(const Rectangle& rectangle) const {
  return *std::ranges::min_element(
      bodies_, {}, [&](const Rectangle& body) { return geometry::distance_m(rectangle, body); });
}

}  // namespace roadbed::planning::obstacles
