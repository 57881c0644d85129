#include "roadbed/planning/lateral/planned_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::planning::inline lateral {
namespace {

constexpr int kNewtonSteps = 8;
constexpr double kLongestStep_m = 5.0;
constexpr double kSlopeAcross = 5.0;  // slope d′ of a vehicle that stands across the line
constexpr double kLeastAlongLine = 0.05;

/// p′ = along · t + across · n, and the parts of p″.
struct FrameMotion {
  double along, across, along_d1, across_d1;
};

FrameMotion frame_motion(const ReferencePoint& at, const LateralState& lateral) {
  const double kappa = at.curvature_per_m;
  return {.along = std::max(kLeastAlongLine, 1.0 - kappa * lateral.d_m),
          .across = lateral.d_slope,
          .along_d1 = -at.curvature_d1_per_m2 * lateral.d_m - kappa * lateral.d_slope,
          .across_d1 = lateral.d_curvature_per_m};
}

double curvature_of(const FrameMotion& m, double kappa) {
  const double speed = std::hypot(m.along, m.across);
  const double turn =
      m.along * (m.across_d1 + kappa * m.along) - m.across * (m.along_d1 - kappa * m.across);
  return turn / (speed * speed * speed);
}

/// d″ that gives a path the curvature k: the inverse of curvature_of.
double lateral_curvature(const FrameMotion& m, double kappa, double k) {
  const double speed = std::hypot(m.along, m.across);
  return (k * speed * speed * speed + m.across * (m.along_d1 - kappa * m.across)) / m.along -
         kappa * m.along;
}

geometry::Pose2 front_of(const PlannedPath::Place& rear, double wheelbase_m) {
  const Eigen::Vector2d front = rear.pose * Eigen::Vector2d(wheelbase_m, 0.0);
  return {.x_m = front.x(),
          .y_m = front.y(),
          .heading_rad = rear.pose.heading_rad + std::atan(wheelbase_m * rear.curvature_per_m)};
}

}  // namespace

PlannedPath::PlannedPath(const ReferenceLine& line, Lateral lateral)
    : line_(&line), lateral_(std::move(lateral)) {}

PlannedPath::Place PlannedPath::place_at(double s_m) const {
  const ReferencePoint at = line_->at(s_m);
  const LateralState lateral = lateral_(s_m);
  const FrameMotion motion = frame_motion(at, lateral);
  const Eigen::Vector2d left{-std::sin(at.heading_rad), std::cos(at.heading_rad)};
  const Eigen::Vector2d place = at.in_map + lateral.d_m * left;
  return {.pose = {.x_m = place.x(),
                   .y_m = place.y(),
                   .heading_rad = at.heading_rad + std::atan2(motion.across, motion.along)},
          .curvature_per_m = curvature_of(motion, at.curvature_per_m),
          .stretch = std::hypot(motion.along, motion.across)};
}

geometry::Pose2 PlannedPath::front_pose_at(double s_m, double wheelbase_m) const {
  return front_of(place_at(s_m), wheelbase_m);
}

double PlannedPath::nearest_front_s_m(const Eigen::Vector2d& front_in_map, double wheelbase_m,
                                      double near_s_m) const {
  double s = near_s_m;
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Place rear = place_at(s);
    const Eigen::Vector2d offset_in_front = front_of(rear, wheelbase_m).inverse() * front_in_map;
    const double turn = wheelbase_m * rear.curvature_per_m;
    const double stretch = rear.stretch * std::hypot(1.0, turn);  // of the front axle's path
    const double step = std::clamp(offset_in_front.x() / stretch, -kLongestStep_m, kLongestStep_m);
    s += step;
    if (std::abs(step) < 1e-9) break;
  }
  return s;
}

LateralState lateral_state(const ReferenceLine& line, const geometry::Pose2& map_from_vehicle,
                           double curvature_per_m, double near_s_m) {
  const geometry::LinePosition foot = line.project(map_from_vehicle.position(), near_s_m);
  const ReferencePoint at = line.at(foot.s_m);
  const double turned = geometry::wrap_angle(map_from_vehicle.heading_rad - at.heading_rad);
  LateralState state{.s_m = foot.s_m, .d_m = foot.d_m};
  const double slope =
      std::cos(turned) > 0.0 ? std::tan(turned) : std::copysign(kSlopeAcross, turned);
  const double along = std::max(kLeastAlongLine, 1.0 - at.curvature_per_m * foot.d_m);
  state.d_slope = std::clamp(along * slope, -kSlopeAcross, kSlopeAcross);
  const FrameMotion motion = frame_motion(at, state);
  state.d_curvature_per_m = lateral_curvature(motion, at.curvature_per_m, curvature_per_m);
  return state;
}

}  // namespace roadbed::planning::lateral
