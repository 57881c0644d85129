#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "roadbed/geometry/fit_curve.h"
#include "roadbed/planning/corridor.h"
#include "roadbed/planning/reference_line.h"
#include "roadbed/planning/reference_line_data.h"
#include "roadbed/planning/route_path.h"

namespace roadbed::planning {
namespace {

std::vector<Eigen::Vector2d> positions(const RoutePath& path) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(path.points.size());
  for (const RoutePathPoint& point : path.points) points.push_back(point.in_map);
  return points;
}

// Station of the curve beside a length of the path.
double station_beside(const geometry::SmoothCurve& curve, const geometry::Polyline& path,
                      double path_m) {
  const double scale = curve.length_m() / path.length_m();
  const double s_m = curve.project(path.at(path_m), scale * path_m).s_m;
  return std::clamp(s_m, 0.0, curve.length_m());
}

// Walks along the path with the curve, so that loops and crossings cannot be mixed up.
std::vector<Corridor> corridor_along(const map::RoadMap& road_map, const RoutePath& path,
                                     const geometry::SmoothCurve& curve, double from_m,
                                     double step_m, double default_speed_mps) {
  std::vector<Corridor> corridor;
  std::size_t i = 0;
  const auto squared = [&](std::size_t k, const Eigen::Vector2d& at) {
    return (path.points[k].in_map - at).squaredNorm();
  };
  for (double s = from_m; s <= curve.length_m(); s += step_m) {
    const geometry::CurvePoint point = curve.at(s);
    while (i + 1 < path.points.size() &&
           squared(i + 1, point.position) <= squared(i, point.position)) {
      ++i;
    }
    const RoutePathPoint& beside = path.points[i];
    corridor.push_back(room_beside(road_map, beside.lane, beside.share, point, default_speed_mps,
                                   beside.reversed));
  }
  return corridor;
}

}  // namespace

ReferenceLine ReferenceLine::along(const map::RoadMap& road_map, const Route& route,
                                   const ReferenceLineOptions& options) {
  const RoutePath path = path_along(road_map, route,
                                    {.step_m = options.step_m,
                                     .lane_change_length_m = options.lane_change_length_m,
                                     .extend_m = options.extend_m});
  const geometry::Polyline centreline(positions(path));
  geometry::FittedCurve fitted = geometry::fit_curve(centreline.points(), fit_options(options));
  auto data = std::make_shared<Data>();
  data->curve = std::move(fitted.curve);
  data->largest_move_m = fitted.largest_move_m;
  data->start_m = station_beside(data->curve, centreline, path.start_m);
  data->goal_s_m = station_beside(data->curve, centreline, path.goal_m) - data->start_m;
  data->corridor = corridor_along(road_map, path, data->curve, data->start_m, data->corridor_step_m,
                                  options.default_speed_mps);
  return ReferenceLine(std::move(data));
}

}  // namespace roadbed::planning
