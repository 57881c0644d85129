#include "roadbed/tools/simulation/path_keeper.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/angle.h"

namespace roadbed::tools {
namespace {

using planning::LateralState;
using planning::Rejection;

constexpr double kReturn_m = 20.0;
constexpr double kBeyondTheEdge_m[] = {0.0, 0.3, 0.6};

/// 1 up to `from`, 0 from `from` + kReturn_m on.
double fade(double s_m, double from_m) {
  const double share = std::clamp((s_m - from_m) / kReturn_m, 0.0, 1.0);
  return 1.0 - share * share * (3.0 - 2.0 * share);
}

/// The line as planning sees it: past `end_m`, where the vehicle never comes, it goes on straight
/// with the room that it has there, so that no bend or dead end behind the goal matters.
planning::LineView straight_past(const planning::ReferenceLine& line, double end_m) {
  const auto at = [&line, end_m](double s_m) {
    planning::ReferencePoint point = line.at(std::min(s_m, end_m));
    if (s_m <= end_m) return point;
    const Eigen::Vector2d along{std::cos(point.heading_rad), std::sin(point.heading_rad)};
    return planning::ReferencePoint{.s_m = s_m,
                                    .in_map = point.in_map + (s_m - end_m) * along,
                                    .heading_rad = point.heading_rad};
  };
  const auto corridor_at = [&line, end_m](double s_m) {
    return line.corridor_at(std::min(s_m, end_m));
  };
  return {at, corridor_at};
}

}  // namespace

PathKeeper::PathKeeper(const Scenario& scenario, const World& world, const Bounds& bounds)
    : scenario_(scenario),
      world_(world),
      bounds_(bounds),
      line_(straight_past(world.line, world.line.goal_s_m() + scenario.vehicle.front_m() + 1.0)) {}

LateralState PathKeeper::start_state(const VehicleState& measured) {
  const control::SingleTrackState& motion = measured.motion;
  const double curvature = std::tan(motion.steering_rad) / scenario_.vehicle.wheelbase_m;
  const LateralState here = lateral_state(world_.line, motion.pose, curvature, s_m_);
  s_m_ = here.s_m;
  from_measurement_ = true;
  if (!path_) return here;
  LateralState planned = path_->lateral_at(here.s_m);
  planned.s_m = here.s_m;
  const double turned =
      geometry::wrap_angle(path_->pose_at(here.s_m).heading_rad - motion.pose.heading_rad);
  from_measurement_ = std::abs(planned.d_m - here.d_m) > bounds_.tracking_error_m ||
                      std::abs(turned) > bounds_.heading_error_rad;
  return from_measurement_ ? here : planned;
}

void PathKeeper::plan(double t_s, const VehicleState& measured, double target_mps) {
  const LateralState start = start_state(measured);
  planning::PlanOptions options;
  options.clearance_m = scenario_.options.clearance_m;
  planning::PlanInput input{.line = line_,
                            .start = start,
                            .start_t_s = t_s,
                            .speed = {.speed_mps = measured.motion.speed_mps,
                                      .acceleration_mps2 = measured.acceleration_mps2,
                                      .target_mps = target_mps},
                            .obstacles = world_.obstacles,
                            .static_field = world_.field.get(),
                            .origin_in_source = world_.road_map.origin_in_source(),
                            .previous_d_m = {}};
  if (path_) {
    input.previous_d_m = [this](double s_m) { return path_->lateral_at(s_m).d_m; };
  }
  // In the sharpest turns of real maps no body keeps to its lane; the road is wider there.
  for (const double beyond_m : kBeyondTheEdge_m) {
    options.border_margin_m = -beyond_m;
    plan_ = planning::plan_path(input, scenario_.vehicle, options);
    beyond_the_edge_m_ = beyond_m;
    if (plan_.chosen || something_is_in_the_way()) break;
  }
  if (plan_.chosen) {
    path_end_s_m_ = plan_.start.s_m + plan_.chosen->end_l_m;
    checked_to_s_m_ = plan_.start.s_m + options.max_l_m;
    path_.emplace(world_.line, [kept = plan_](double s_m) { return kept.lateral_at(s_m); });
  } else if (!path_) {
    path_end_s_m_ = checked_to_s_m_ = start.s_m;
    path_.emplace(world_.line,
                  [d_m = start.d_m](double s_m) { return LateralState{.s_m = s_m, .d_m = d_m}; });
  }
}

bool PathKeeper::something_is_in_the_way() const {
  return plan_.rejected[static_cast<std::size_t>(Rejection::collision)] > 0;
}

PlannedPath PathKeeper::expected_path() const {
  return PlannedPath(world_.line, [path = *path_, end_m = path_end_s_m_](double s_m) {
    LateralState lateral = path.lateral_at(s_m);
    lateral.d_m *= fade(s_m, end_m);  // its slope is small enough to leave the heading alone
    return lateral;
  });
}

}  // namespace roadbed::tools
