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
  const geometry::Rectangle core = swept_over(span, part_);
  if (!field_.is_made_for(core)) return 0.0;
  double least_m = within_m;
  for (const map::ObstacleKind kind : kinds_) {
    const auto found = field_.nearest(core, least_m + part_.radius_m, kind);
    if (found) least_m = std::min(least_m, found->distance_m - part_.radius_m);
  }
  return std::max(0.0, least_m);
}

}  // namespace roadbed::planning::audit
