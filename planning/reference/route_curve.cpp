#include "roadbed/planning/reference/route_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadbed::planning::inline reference {
namespace {

// Station of the curve beside a length of the path.
double station_beside(const geometry::SmoothCurve& curve, const geometry::Polyline& path,
                      double path_m) {
  const double scale = curve.length_m() / path.length_m();
  const double s_m = curve.project(path.at(path_m), scale * path_m).s_m;
  return std::clamp(s_m, 0.0, curve.length_m());
}

}  // namespace

geometry::Polyline centreline_of(const RoutePath& path) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(path.points.size());
  for (const RoutePathPoint& point : path.points) points.push_back(point.in_map);
  return geometry::Polyline(std::move(points));
}

RouteCurve draw_curve(const RoutePath& path, const geometry::Polyline& through,
                      const geometry::FitOptions& options) {
  geometry::FittedCurve fitted = geometry::fit_curve(through.points(), options);
  const geometry::Polyline centreline = centreline_of(path);
  const double start_m = station_beside(fitted.curve, centreline, path.start_m);
  const double goal_m = station_beside(fitted.curve, centreline, path.goal_m);
  return {std::move(fitted.curve), fitted.largest_move_m, start_m, goal_m - start_m};
}

std::vector<std::size_t> points_beside(const RoutePath& path, const geometry::SmoothCurve& curve,
                                       double from_m, double step_m, double look_ahead_m) {
  const auto& points = path.points;
  std::vector<std::size_t> beside;
  std::size_t i = 0;
  for (double s_m = from_m; s_m <= curve.length_m(); s_m += step_m) {
    const Eigen::Vector2d at = curve.at(s_m).position;
    const auto squared = [&](std::size_t k) { return (points[k].in_map - at).squaredNorm(); };
    double ahead_m = 0.0;
    for (std::size_t k = i + 1; k < points.size(); ++k) {
      if (squared(k) <= squared(i)) {
        i = k;
        ahead_m = 0.0;
      } else if ((ahead_m += (points[k].in_map - points[k - 1].in_map).norm()) > look_ahead_m) {
        break;
      }
    }
    beside.push_back(i);
  }
  return beside;
}

}  // namespace roadbed::planning::reference
