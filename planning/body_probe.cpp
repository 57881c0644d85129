#include "roadbed/planning/body_probe.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadbed::planning {
namespace {

// About as long as wide: then the circles stick out least for their number.
int circle_count(const geometry::VehicleShape& body) {
  return std::clamp(static_cast<int>(std::ceil(1.5 * body.length_m / body.width_m)), 1, 16);
}

}  // namespace

BodyProbe::BodyProbe(const map::ClearanceField& field, const geometry::Trajectory& drive,
                     const geometry::VehicleShape& body, std::vector<map::ObstacleKind> kinds)
    : Probe(drive, body.reach_m()),
      field_(field),
      body_(body),
      kinds_(std::move(kinds)),
      middle_x_m_(0.5 * body.length_m - body.rear_overhang_m),
      radius_m_(0.5 * std::hypot(body.length_m, body.width_m)),
      circles_(geometry::covering_circles(body, circle_count(body))) {}

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
  const double around_m = field_bound_m(pose.position() + middle_x_m_ * forward) - radius_m_;
  if (around_m >= enough_m) return around_m;
  double least_m = field_.horizon_m();
  for (const double x_m : circles_.centres_x_m) {
    least_m = std::min(least_m, field_bound_m(pose.position() + x_m * forward));
  }
  return std::max({0.0, around_m, least_m - circles_.radius_m});
}

std::optional<Probe::Near> BodyProbe::nearest(const Span& span, double within_m) const {
  const geometry::Pose2 pose = middle_pose_of(span);
  std::optional<Near> least;
  for (const map::ObstacleKind kind : kinds_) {
    const auto found = field_.nearest(pose, body_, within_m, kind);
    if (found && (!least || found->distance_m < least->distance_m)) {
      least = Near{found->distance_m, found->witness};
    }
  }
  return least;
}

}  // namespace roadbed::planning
