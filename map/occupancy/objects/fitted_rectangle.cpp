#include "roadbed/map/occupancy/objects/fitted_rectangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace roadbed::map::inline occupancy::inline objects {
namespace {

constexpr double kNear_m = 0.1;

/// Points in the frame of an axis, and the box around them.
struct Turned {
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d least, most;

  Turned(const Eigen::Vector2d& axis, std::span<const Eigen::Vector2d> from) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    least.setConstant(infinity);
    most.setConstant(-infinity);
    points.reserve(from.size());
    for (const Eigen::Vector2d& point : from) {
      const Eigen::Vector2d turned(axis.dot(point), axis.x() * point.y() - axis.y() * point.x());
      least = least.cwiseMin(turned);
      most = most.cwiseMax(turned);
      points.push_back(turned);
    }
  }

  double closeness() const {
    double sum = 0.0;
    for (const Eigen::Vector2d& point : points) {
      sum += 1.0 / std::max((point - least).cwiseMin(most - point).minCoeff(), kNear_m);
    }
    return sum;
  }
};

std::vector<Eigen::Vector2d> thinned(std::span<const Eigen::Vector2d> points) {
  std::set<std::pair<long, long>> taken;
  std::vector<Eigen::Vector2d> kept;
  for (const Eigen::Vector2d& point : points) {
    if (taken.emplace(std::lround(point.x() / kNear_m), std::lround(point.y() / kNear_m)).second) {
      kept.push_back(point);
    }
  }
  return kept;
}

}  // namespace

geometry::Rectangle rectangle_along(const Eigen::Vector2d& axis,
                                    std::span<const Eigen::Vector2d> points) {
  const Turned turned(axis, points);
  const Eigen::Vector2d middle = 0.5 * (turned.least + turned.most);
  const Eigen::Vector2d half = 0.5 * (turned.most - turned.least);
  const Eigen::Vector2d left(-axis.y(), axis.x());
  return {.centre = middle.x() * axis + middle.y() * left,
          .axis = axis,
          .half_length_m = half.x(),
          .half_width_m = half.y()};
}

geometry::Rectangle fitted_rectangle(std::span<const Eigen::Vector2d> points) {
  const std::vector<Eigen::Vector2d> few = thinned(points);
  Eigen::Vector2d best(1.0, 0.0);
  double most = -1.0;
  for (int degrees = 0; degrees < 90; ++degrees) {
    const double angle_rad = degrees * std::numbers::pi / 180.0;
    const Eigen::Vector2d axis(std::cos(angle_rad), std::sin(angle_rad));
    const double closeness = Turned(axis, few).closeness();
    if (closeness > most) {
      most = closeness;
      best = axis;
    }
  }
  geometry::Rectangle fitted = rectangle_along(best, points);
  if (fitted.half_width_m > fitted.half_length_m) {
    std::swap(fitted.half_width_m, fitted.half_length_m);
    fitted.axis = {best.y(), -best.x()};
  }
  return fitted;
}

}  // namespace roadbed::map::occupancy::objects
