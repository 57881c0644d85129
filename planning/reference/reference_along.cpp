#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "roadbed/geometry/curves/fit_curve.h"
#include "roadbed/planning/reference/line_driving.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/reference/reference_line_data.h"
#include "roadbed/planning/route/route_path.h"

namespace roadbed::planning::inline reference {
namespace {

constexpr double kBesideBend_m = 12.0;  // that is drawn anew with a bend, before and behind it
constexpr double kWidenBy_m = 0.3;
constexpr double kOffSurface_m = 0.05;  // still is on the road

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
    corridor.push_back(room_beside(road_map, beside.lane, beside.fraction, point, default_speed_mps,
                                   beside.reversed));
  }
  return corridor;
}

// The curve of a route, and where on it the route is.
struct DrawnCurve {
  geometry::SmoothCurve curve;
  double largest_move_m, start_m, goal_s_m;
};

DrawnCurve drawn_curve(const geometry::Polyline& centreline, const RoutePath& path,
                       const geometry::FitOptions& options) {
  geometry::FittedCurve fitted = geometry::fit_curve(centreline.points(), options);
  const double start_m = station_beside(fitted.curve, centreline, path.start_m);
  const double goal_m = station_beside(fitted.curve, centreline, path.goal_m);
  return {std::move(fitted.curve), fitted.largest_move_m, start_m, goal_m - start_m};
}

LineDriving driving_along(const DrawnCurve& drawn, const geometry::VehicleShape& vehicle,
                          const map::RoadMap& road_map) {
  const LineView line(
      [&](double s_m) {
        const geometry::CurvePoint point = drawn.curve.at(drawn.start_m + s_m);
        return ReferencePoint{.s_m = s_m,
                              .in_map = point.position,
                              .heading_rad = point.heading_rad,
                              .curvature_per_m = point.curvature_per_m[0],
                              .curvature_d1_per_m2 = point.curvature_per_m[1]};
      },
      [](double) { return Corridor{}; });
  return driving_along(line, drawn.goal_s_m, vehicle, [&](const Eigen::Vector2d& place) {
    return road_map.on_surface(place, kOffSurface_m);
  });
}

// Bends that are too sharp, by the length of the path, with what lies before and behind them.
std::vector<geometry::WiderStretch> wider_stretches(const std::vector<LineFault>& bends,
                                                    const DrawnCurve& drawn, double path_m) {
  const double path_per_line = path_m / drawn.curve.length_m();
  std::vector<geometry::WiderStretch> stretches;
  for (const LineFault& bend : bends) {
    stretches.push_back({path_per_line * (drawn.start_m + bend.from_s_m) - kBesideBend_m,
                         path_per_line * (drawn.start_m + bend.to_s_m) + kBesideBend_m, 0.0});
  }
  return stretches;
}

// Bends that the vehicle cannot steer are drawn wider, as far as it leaves the road no more for it.
void widen_bends(const map::RoadMap& road_map, const RoutePath& path,
                 const geometry::Polyline& centreline, const ReferenceLineOptions& options,
                 DrawnCurve& drawn, std::vector<std::string>& notes) {
  const geometry::VehicleShape& vehicle = *options.corner_vehicle;
  const LineDriving first = driving_along(drawn, vehicle, road_map);
  LineDriving driving = first;
  geometry::FitOptions fit = fit_options(options);
  fit.wider = wider_stretches(first.bends, drawn, centreline.length_m());
  for (double wide_m = options.max_smoothing_m + kWidenBy_m;
       !driving.bends.empty() && wide_m < options.max_widening_m + 1e-9; wide_m += kWidenBy_m) {
    for (geometry::WiderStretch& stretch : fit.wider) stretch.tolerance_m = wide_m;
    DrawnCurve wider = drawn_curve(centreline, path, fit);
    LineDriving on_wider = driving_along(wider, vehicle, road_map);
    if (length_of(on_wider.leaves) > length_of(first.leaves)) break;
    if (length_of(on_wider.bends) >= length_of(driving.bends)) continue;
    driving = std::move(on_wider);
    drawn = std::move(wider);
  }
  for (const auto* faults : {&driving.bends, &driving.leaves}) {
    for (const LineFault& fault : *faults) {
      notes.push_back(fmt::format("from {:.1f} m to {:.1f} m the line {}", fault.from_s_m,
                                  fault.to_s_m, fault.reason));
    }
  }
}

}  // namespace

ReferenceLine ReferenceLine::along(const map::RoadMap& road_map, const Route& route,
                                   const ReferenceLineOptions& options) {
  const RoutePath path = path_along(road_map, route,
                                    {.step_m = options.step_m,
                                     .lane_change_length_m = options.lane_change_length_m,
                                     .extend_m = options.extend_m});
  const geometry::Polyline centreline(positions(path));
  DrawnCurve drawn = drawn_curve(centreline, path, fit_options(options));
  auto data = std::make_shared<ReferenceLineData>();
  if (options.corner_vehicle) {
    widen_bends(road_map, path, centreline, options, drawn, data->notes);
  }
  data->curve = std::move(drawn.curve);
  data->largest_move_m = drawn.largest_move_m;
  data->start_m = drawn.start_m;
  data->goal_s_m = drawn.goal_s_m;
  data->corridor = corridor_along(road_map, path, data->curve, data->start_m, data->corridor_step_m,
                                  options.default_speed_mps);
  return ReferenceLine(std::move(data));
}

}  // namespace roadbed::planning::reference
