#include "roadbed/planning/audit/body_probe.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadbed::planning::inline audit {
namespace {

// About as long as wide: then the circles stick out least for their number.
geometry::CoveringCircles circles_over(const geometry::BodyPart& part) {
  const double length_m = part.length_m(), width_m = part.width_m();
  const int count =
      width_m > 0.0 ? static_cast<int>(std::clamp(std::ceil(1.5 * length_m / width_m), 1.0, 16.0))
                    : 1;
  const double section_m = length_m / count;
  geometry::CoveringCircles circles{
      .centres_x_m = {}, .radius_m = 0.5 * std::hypot(section_m, width_m) + part.radius_m};
  for (int i = 0; i < count; ++i) {
    circles.centres_x_m.push_back(part.rear_m + (i + 0.5) * section_m);
  }
  return circles;
}

}  // namespace

BodyProbe::BodyProbe(const map::ClearanceField& field, const geometry::Trajectory& drive,
                     const geometry::BodyPart& part, std::vector<map::ObstacleKind> kinds)
    : ClearanceProbe(drive, part.reach_m()),
      field_(field),
      part_(part),
      kinds_(std::move(kinds)),
      middle_in_vehicle_(part.middle_in_vehicle()),
      radius_m_(part.circumradius_m()),
      circles_(circles_over(part)) {}

double BodyProbe::field_bound_m(const Eigen::Vector2d& point) const {
  double least_m = field_.horizon_m();
  for (const map::ObstacleKind kind : kinds_) {
    least_m = std::min(least_m, field_.distance_bound_m(point, kind));
  }
  return least_m;
}

double BodyProbe::lower_bound_m(const Span& span, double enough_m) const {
  const geometry::Pose2 pose = middle_pose_of(span);
  const Eigen::Vector2d forward(std::cos(pose.heading_rad), std::sin(pose.heading_rad));
  const Eigen::Vector2d left(-forward.y(), forward.x());
  const Eigen::Vector2d beside = pose.position() + middle_in_vehicle_.y() * left;
  const double around_m = field_bound_m(beside + middle_in_vehicle_.x() * forward) - radius_m_;
  if (around_m >= enough_m) return around_m;
  double least_m = field_.horizon_m();
  for (const double x_m : circles_.centres_x_m) {
    least_m = std::min(least_m, field_bound_m(beside + x_m * forward));
  }
  return std::max({0.0, around_m, least_m - circles_.radius_m});
}

std::optional<ClearanceProbe::Near> BodyProbe::nearest(const Span& span, double within_m) const {
  const geometry::Rectangle core = part_.core_at(middle_pose_of(span));
  std::optional<Near> least;
  for (const map::ObstacleKind kind : kinds_) {
    const auto found = field_.nearest(core, within_m + part_.radius_m, kind);
    if (!found) continue;
    const double distance_m = std::max(0.0, found->distance_m - part_.radius_m);
    if (!least || distance_m < least->distance_m) least = Near{distance_m, found->witness};
  }
  return least;
}

double BodyProbe::swept_bound_m(const Span& span, double within_m) const {
  if (!(motion_bound_m(span) <= part_.reach_m())) return 0.0;
  const geometry::Rectangle core = swept_over(span);
  if (!field_.is_made_for(core)) return 0.0;
  double least_m = within_m;
  for (const map::ObstacleKind kind : kinds_) {
    const auto found = field_.nearest(core, least_m + part_.radius_m, kind);
    if (found) least_m = std::min(least_m, found->distance_m - part_.radius_m);
  }
  return std::max(0.0, least_m);
}

// A point (x, y) of the body, moved by (u, v) and turned by δ as seen from the middle of the span,
// is at most |y δ| + |x| δ²/2 farther ahead than u, and x δ and at most |y| δ²/2 + |x δ³|/6 farther
// to the left than v. All of that is convex, and greatest at the ends of segments.
geometry::Rectangle BodyProbe::swept_over(const Span& span) const {
  const geometry::Pose2 middle = middle_pose_of(span);
  const Eigen::Vector2d forward(std::cos(middle.heading_rad), std::sin(middle.heading_rad));
  const Eigen::Vector2d left(-forward.y(), forward.x());
  const double x_m = std::max(std::abs(part_.rear_m), std::abs(part_.front_m));
  const double y_m = std::max(std::abs(part_.right_m), std::abs(part_.left_m));
  double ahead_m = 0.0, behind_m = 0.0, to_left_m = 0.0, to_right_m = 0.0;
  const auto take = [&](const geometry::Pose2& at) {
    const Eigen::Vector2d moved = at.position() - middle.position();
    const double turned_rad = at.heading_rad - middle.heading_rad, turn_rad = std::abs(turned_rad);
    const double along_m = moved.dot(forward), across_m = moved.dot(left);
    const double more_along_m = turn_rad * (y_m + 0.5 * x_m * turn_rad);
    const double more_across_m = turn_rad * turn_rad * (0.5 * y_m + x_m * turn_rad / 6.0);
    const double at_rear_m = across_m + part_.rear_m * turned_rad,
                 at_front_m = across_m + part_.front_m * turned_rad;
    ahead_m = std::max(ahead_m, along_m + more_along_m);
    behind_m = std::max(behind_m, more_along_m - along_m);
    to_left_m = std::max(to_left_m, std::max(at_rear_m, at_front_m) + more_across_m);
    to_right_m = std::max(to_right_m, more_across_m - std::min(at_rear_m, at_front_m));
  };
  take(pose_at(span.segment, span.from));
  for (std::size_t i = 1; i < span.segments; ++i) take(pose_at(span.segment + i, 0.0));
  take(pose_at(span.segment + span.segments - 1, span.to));
  const double rear_m = part_.rear_m - behind_m - kRounding_m,
               front_m = part_.front_m + ahead_m + kRounding_m,
               right_m = part_.right_m - to_right_m - kRounding_m,
               left_m = part_.left_m + to_left_m + kRounding_m;
  return {.centre = middle.position() + 0.5 * (rear_m + front_m) * forward +
                    0.5 * (right_m + left_m) * left,
          .axis = forward,
          .half_length_m = 0.5 * (front_m - rear_m),
          .half_width_m = 0.5 * (left_m - right_m)};
}

}  // namespace roadbed::planning::audit
