#include "roadbed/planning/audit/clearance_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbed::planning::inline audit {

ClearanceProbe::ClearanceProbe(const geometry::Trajectory& drive, double reach_m)
    : drive_(drive), reach_m_(reach_m), moved_m_(segments() + 1) {
  for (std::size_t segment = 0; segment < segments(); ++segment) {
    moved_m_[segment + 1] = moved_m_[segment] + segment_motion_m(segment) + 2.0 * kRounding_m;
  }
  sum_rounding_m_ =
      std::numeric_limits<double>::epsilon() * static_cast<double>(segments()) * moved_m_.back();
}

std::size_t ClearanceProbe::segments() const {
  return std::max<std::size_t>(1, drive_.points().size() - 1);
}

geometry::TrajectoryPoint ClearanceProbe::state_at(std::size_t segment, double fraction) const {
  const auto& samples = drive_.points();
  return geometry::interpolate(samples[segment], samples[std::min(segment + 1, samples.size() - 1)],
                               fraction);
}

double ClearanceProbe::time_at(std::size_t segment, double fraction) const {
  const auto& samples = drive_.points();
  const double from_s = samples[segment].t_s;
  return from_s + fraction * (samples[std::min(segment + 1, samples.size() - 1)].t_s - from_s);
}

std::size_t ClearanceProbe::next_after(std::size_t segment, double spare_m) const {
  ++segment;
  if (!is_continuous() || !(spare_m >= 0.0) || !std::isfinite(moved_m_.back())) return segment;
  const auto after = moved_m_.begin() + static_cast<std::ptrdiff_t>(segment) + 1;
  const auto beyond =
      std::upper_bound(after, moved_m_.end(), moved_m_[segment] + spare_m - sum_rounding_m_);
  return static_cast<std::size_t>(beyond - moved_m_.begin()) - 1;
}

ClearanceProbe::Place ClearanceProbe::place_moved(double moved_m) const {
  const auto after = std::upper_bound(moved_m_.begin() + 1, moved_m_.end() - 1, moved_m);
  const auto segment = static_cast<std::size_t>(after - moved_m_.begin()) - 1;
  const double fraction =
      (moved_m - moved_m_[segment]) / (moved_m_[segment + 1] - moved_m_[segment]);
  return {segment, std::clamp(fraction, 0.0, 1.0)};
}

double ClearanceProbe::moved_at_m(double t_s) const {
  const auto& samples = drive_.points();
  if (samples.size() == 1) return 0.0;
  const auto after = std::upper_bound(
      samples.begin() + 1, samples.end() - 1, t_s,
      [](double t, const geometry::TrajectoryPoint& sample) { return t < sample.t_s; });
  const auto segment = static_cast<std::size_t>(after - samples.begin()) - 1;
  const double whole_s = samples[segment + 1].t_s - samples[segment].t_s;
  const double fraction = std::clamp((t_s - samples[segment].t_s) / whole_s, 0.0, 1.0);
  return moved_m_[segment] + fraction * (moved_m_[segment + 1] - moved_m_[segment]);
}

geometry::Pose2 ClearanceProbe::pose_at(std::size_t segment, double fraction) const {
  const auto& samples = drive_.points();
  const geometry::TrajectoryPoint& a = samples[segment];
  const geometry::TrajectoryPoint& b = samples[std::min(segment + 1, samples.size() - 1)];
  return {a.x_m + fraction * (b.x_m - a.x_m), a.y_m + fraction * (b.y_m - a.y_m),
          a.heading_rad + fraction * (b.heading_rad - a.heading_rad)};
}

double ClearanceProbe::segment_motion_m(std::size_t segment) const {
  const auto& samples = drive_.points();
  const geometry::TrajectoryPoint& a = samples[segment];
  const geometry::TrajectoryPoint& b = samples[std::min(segment + 1, samples.size() - 1)];
  const double dx_m = b.x_m - a.x_m, dy_m = b.y_m - a.y_m;
  const double way_m = std::sqrt(dx_m * dx_m + dy_m * dy_m);
  return way_m + reach_m_ * std::abs(b.heading_rad - a.heading_rad);
}

double ClearanceProbe::motion_bound_m(const Span& span) const {
  if (span.segments == 1) {
    return 0.5 * (span.to - span.from) * segment_motion_m(span.segment) + kRounding_m;
  }
  const double middle_m = moved_m_[span.middle_segment()];
  return std::max(middle_m - moved_m_[span.segment],
                  moved_m_[span.segment + span.segments] - middle_m) +
         sum_rounding_m_;
}

// A point (x, y) of the body, moved by (u, v) and turned by δ as seen from the middle of the span,
// is at most |y δ| + |x| δ²/2 farther ahead than u, and x δ and at most |y| δ²/2 + |x δ³|/6 farther
// to the left than v. All of that is convex, and greatest at the ends of segments.
geometry::Rectangle ClearanceProbe::swept_over(const Span& span,
                                               const geometry::BodyPart& part) const {
  const geometry::Pose2 middle = middle_pose_of(span);
  const Eigen::Vector2d forward(std::cos(middle.heading_rad), std::sin(middle.heading_rad));
  const Eigen::Vector2d left(-forward.y(), forward.x());
  const double x_m = std::max(std::abs(part.rear_m), std::abs(part.front_m));
  const double y_m = std::max(std::abs(part.right_m), std::abs(part.left_m));
  double ahead_m = 0.0, behind_m = 0.0, to_left_m = 0.0, to_right_m = 0.0;
  const auto take = [&](const geometry::Pose2& at) {
    const Eigen::Vector2d moved = at.position() - middle.position();
    const double turned_rad = at.heading_rad - middle.heading_rad, turn_rad = std::abs(turned_rad);
    const double along_m = moved.dot(forward), across_m = moved.dot(left);
    const double more_along_m = turn_rad * (y_m + 0.5 * x_m * turn_rad);
    const double more_across_m = turn_rad * turn_rad * (0.5 * y_m + x_m * turn_rad / 6.0);
    const double at_rear_m = across_m + part.rear_m * turned_rad,
                 at_front_m = across_m + part.front_m * turned_rad;
    ahead_m = std::max(ahead_m, along_m + more_along_m);
    behind_m = std::max(behind_m, more_along_m - along_m);
    to_left_m = std::max(to_left_m, std::max(at_rear_m, at_front_m) + more_across_m);
    to_right_m = std::max(to_right_m, more_across_m - std::min(at_rear_m, at_front_m));
  };
  take(pose_at(span.segment, span.from));
  for (std::size_t i = 1; i < span.segments; ++i) take(pose_at(span.segment + i, 0.0));
  take(pose_at(span.segment + span.segments - 1, span.to));
  const double rear_m = part.rear_m - behind_m - kRounding_m,
               front_m = part.front_m + ahead_m + kRounding_m,
               right_m = part.right_m - to_right_m - kRounding_m,
               left_m = part.left_m + to_left_m + kRounding_m;
  return {.centre = middle.position() + 0.5 * (rear_m + front_m) * forward +
                    0.5 * (right_m + left_m) * left,
          .axis = forward,
          .half_length_m = 0.5 * (front_m - rear_m),
          .half_width_m = 0.5 * (left_m - right_m)};
}

}  // namespace roadbed::planning::audit
