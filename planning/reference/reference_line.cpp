#include "roadbed/planning/reference/reference_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/geometry/curves/fit_curve.h"
#include "roadbed/planning/reference/reference_line_data.h"
#include "roadbed/planning/reference/way_point_path.h"

namespace roadbed::planning::inline reference {
namespace {

// Of points along a curve, each looked for from where the one before it was; all over the curve
// only where that is farther than the curve was made to lie.
double largest_distance_m(const std::vector<Eigen::Vector2d>& points,
                          const geometry::SmoothCurve& curve, double expected_m) {
  double largest_m = 0.0, s_m = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double step_m = i > 0 ? (points[i] - points[i - 1]).norm() : 0.0;
    geometry::LinePosition foot = curve.project(points[i], s_m + step_m);
    if (!(std::abs(foot.d_m) <= expected_m)) foot = curve.project(points[i]);
    s_m = foot.s_m;
    largest_m = std::max(largest_m, std::abs(foot.d_m));
  }
  return largest_m;
}

}  // namespace

ReferenceLine::ReferenceLine(std::shared_ptr<const ReferenceLineData> data)
    : data_(std::move(data)) {}

geometry::FitOptions fit_options(const ReferenceLineOptions& options) {
  const geometry::FitOptions defaults;
  const double knot_distance_m = 2.0 * options.step_m;
  return {.knot_distance_m = knot_distance_m,
          .scale_m = std::min(defaults.scale_m, 4.0 * knot_distance_m),
          .tolerance_m = options.max_smoothing_m,
          .max_curvature_per_m = options.max_curvature_per_m};
}

ReferenceLine ReferenceLine::through(const std::vector<Eigen::Vector2d>& way_points_in_map,
                                     double half_width_m, double speed_limit_mps,
                                     const ReferenceLineOptions& options) {
  std::optional<CornerDriving> driving;
  if (options.corner_vehicle) {
    driving = {*options.corner_vehicle, options.corner_speed_mps, half_width_m};
  }
  WayPointPath path = path_through(way_points_in_map, 0.5 * options.step_m, driving);
  auto data = std::make_shared<ReferenceLineData>();
  data->curve = geometry::fit_curve(path.points, fit_options(options)).curve;
  data->goal_s_m = data->curve.length_m();
  data->largest_move_m = largest_distance_m(path.way_points, data->curve, options.max_smoothing_m);
  data->notes = std::move(path.notes);
  if (path.largest_swing_m > half_width_m) {
    data->notes.push_back(fmt::format(
        "between its way-points the line swings out by {:.1f} m at ({:.2f}, {:.2f}), more than the "
        "half width of {:.2f} m; way-points nearer to each other will hold it",
        path.largest_swing_m, path.swing_at.x(), path.swing_at.y(), half_width_m));
  }
  data->corridor.assign(1, {half_width_m, half_width_m, speed_limit_mps});
  return ReferenceLine(std::move(data));
}

double ReferenceLine::length_m() const { return data_->curve.length_m() - data_->start_m; }

double ReferenceLine::goal_s_m() const { return data_->goal_s_m; }

double ReferenceLine::largest_move_m() const { return data_->largest_move_m; }

const std::vector<std::string>& ReferenceLine::notes() const { return data_->notes; }

ReferencePoint ReferenceLine::at(double s_m) const {
  const geometry::CurvePoint point = data_->curve.at(data_->start_m + s_m);
  const auto& k = point.curvature_per_m;
  return {s_m, point.position, point.heading_rad, k[0], k[1], k[2], k[3], k[4]};
}

Corridor ReferenceLine::corridor_at(double s_m) const {
  const auto& corridor = data_->corridor;
  const auto last = static_cast<double>(corridor.size() - 1);
  const double index = std::clamp(s_m / data_->corridor_step_m, 0.0, last);
  const auto before = static_cast<std::size_t>(index);
  const Corridor& a = corridor[before];
  const Corridor& b = corridor[std::min(before + 1, corridor.size() - 1)];
  const double fraction = index - static_cast<double>(before);
  return {std::lerp(a.left_m, b.left_m, fraction), std::lerp(a.right_m, b.right_m, fraction),
          a.speed_limit_mps};
}

geometry::LinePosition ReferenceLine::project(const Eigen::Vector2d& point_in_map,
                                              std::optional<double> near_s_m) const {
  if (near_s_m) *near_s_m += data_->start_m;
  geometry::LinePosition position = data_->curve.project(point_in_map, near_s_m);
  position.s_m -= data_->start_m;
  return position;
}

}  // namespace roadbed::planning::reference
