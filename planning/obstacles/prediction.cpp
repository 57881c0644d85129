#include "roadbed/planning/obstacles/prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace roadbed::planning::inline obstacles {
namespace {

using geometry::Pose2;
using geometry::Trajectory;
using geometry::TrajectoryPoint;

constexpr double kLineStep_s = 0.1;

void check(const ObservedMotion& seen) {
  const bool finite = std::isfinite(seen.t_s) && std::isfinite(seen.pose.x_m) &&
                      std::isfinite(seen.pose.y_m) && std::isfinite(seen.pose.heading_rad) &&
                      std::isfinite(seen.speed_mps) && std::isfinite(seen.turn_rate_radps);
  if (!finite) throw std::invalid_argument("Prediction: every observed number must be finite");
}

// The chord of a circle, in the direction of half the turn: exact, and stable for no turn at all.
Pose2 moved_on_circle(const ObservedMotion& seen, double t_s) {
  const double after_s = t_s - seen.t_s;
  const double half_turn = 0.5 * seen.turn_rate_radps * after_s;
  const double sinc = std::abs(half_turn) < 1e-4 ? 1.0 - half_turn * half_turn / 6.0
                                                 : std::sin(half_turn) / half_turn;
  const double chord_m = seen.speed_mps * after_s * sinc;
  const double direction = seen.pose.heading_rad + half_turn;
  return {seen.pose.x_m + chord_m * std::cos(direction),
          seen.pose.y_m + chord_m * std::sin(direction), seen.pose.heading_rad + 2.0 * half_turn};
}

}  // namespace

double fastest_mps(const Trajectory& motion, double radius_m, double from_s, double to_s) {
  const auto& points = motion.points();
  double fastest = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const TrajectoryPoint &a = points[i], &b = points[i + 1];
    if (b.t_s < from_s || a.t_s > to_s) continue;
    const double motion_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) +
                            radius_m * std::abs(b.heading_rad - a.heading_rad);
    fastest = std::max(fastest, motion_m / (b.t_s - a.t_s));
  }
  return fastest;
}

// Position and heading are linear between points, so that they are farthest off at one of them.
double bend_m(const Trajectory& motion, double radius_m, double from_s, double to_s) {
  const auto& points = motion.points();
  const TrajectoryPoint a = motion.at(from_s), b = motion.at(to_s);
  double most_m = 0.0;
  for (auto at = std::ranges::upper_bound(points, from_s, {}, &TrajectoryPoint::t_s);
       at != points.end() && at->t_s < to_s; ++at) {
    const double fraction = (at->t_s - from_s) / (to_s - from_s);
    const TrajectoryPoint on_chord = interpolate(a, b, fraction);
    most_m = std::max(most_m, std::hypot(at->x_m - on_chord.x_m, at->y_m - on_chord.y_m) +
                                  radius_m * std::abs(at->heading_rad - on_chord.heading_rad));
  }
  const double turn_rad = b.heading_rad - a.heading_rad;
  return most_m + 0.125 * radius_m * turn_rad * turn_rad;
}

Prediction Prediction::recorded(Trajectory motion) {
  if (motion.empty()) throw std::invalid_argument("Prediction: a recorded motion has no point");
  const auto kept = std::make_shared<const Trajectory>(std::move(motion));
  return {[kept](double t_s) { return kept->at(t_s).pose(); },
          [kept](double radius_m, double from_s, double to_s) {
            return planning::fastest_mps(*kept, radius_m, from_s, to_s);
          }};
}

Prediction Prediction::constant_velocity(const ObservedMotion& seen) {
  ObservedMotion straight = seen;
  straight.turn_rate_radps = 0.0;
  return constant_turn(straight);
}

Prediction Prediction::constant_turn(const ObservedMotion& seen) {
  check(seen);
  return {[seen](double t_s) { return moved_on_circle(seen, t_s); },
          [seen](double radius_m, double, double) {
            return std::abs(seen.speed_mps) + radius_m * std::abs(seen.turn_rate_radps);
          }};
}

Prediction Prediction::along_line(const LineView& line, const geometry::LinePosition& at_in_line,
                                  const ObservedMotion& seen, double duration_s) {
  check(seen);
  if (!(duration_s >= 0.0) || !std::isfinite(duration_s)) {
    throw std::invalid_argument(fmt::format(
        "Prediction: the duration must be finite and not negative, got {} s", duration_s));
  }
  const double turned = seen.pose.heading_rad - line.at(at_in_line.s_m).heading_rad;
  const double direction = std::cos(turned) >= 0.0 ? 1.0 : -1.0;
  std::vector<TrajectoryPoint> points;
  for (int i = 0; i <= static_cast<int>(std::ceil(duration_s / kLineStep_s)); ++i) {
    const double after_s = kLineStep_s * i;
    const ReferencePoint at = line.at(at_in_line.s_m + direction * seen.speed_mps * after_s);
    points.push_back({.t_s = seen.t_s + after_s,
                      .x_m = at.in_map.x() - at_in_line.d_m * std::sin(at.heading_rad),
                      .y_m = at.in_map.y() + at_in_line.d_m * std::cos(at.heading_rad),
                      .heading_rad = at.heading_rad + (direction < 0.0 ? std::numbers::pi : 0.0),
                      .speed_mps = seen.speed_mps});
  }
  return recorded(Trajectory(std::move(points)));
}

}  // namespace roadbed::planning::obstacles
