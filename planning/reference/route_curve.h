#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "roadbed/geometry/curves/fit_curve.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/route_path.h"

namespace roadbed::planning::inline reference {

/// The curve of a route, and where on it the route is.
struct RouteCurve {
  geometry::SmoothCurve curve;
  double largest_move_m = 0.0, start_m = 0.0, goal_s_m = 0.0;
};

/// The path's points one behind the other.
geometry::Polyline centreline_of(const RoutePath& path);

/// Smooth curve along a path, or along other points that replace some of the path's.
RouteCurve draw_curve(const RoutePath& path, const geometry::Polyline& through,
                      const geometry::FitOptions& options);

/// For stations `from_m`, `from_m + step_m`, … of a curve the path's point beside it. Walks along
/// the path with the curve, so that loops and crossings cannot be mixed up.
/// @param look_ahead_m  of the path, at each step: what a rounded corner leaves out.
std::vector<std::size_t> points_beside(const RoutePath& path, const geometry::SmoothCurve& curve,
                                       double from_m, double step_m, double look_ahead_m = 0.0);

struct BendsRounded {
  bool any = false;
  /// A line of text for each bend that could not be rounded, and why, and each that remains.
  std::vector<std::string> notes;
};

/// Draws bends that the vehicle cannot steer anew (round_bend), in their own lanes if that is
/// possible, else in the corridor, else as far beyond it as the body is on the curve as it was.
/// Where there is no bend that it cannot steer, the route stays as it is.
BendsRounded round_bends(const map::RoadMap& road_map, const RoutePath& path,
                         const geometry::VehicleShape& vehicle, const geometry::FitOptions& options,
                         RouteCurve& route);

}  // namespace roadbed::planning::reference
