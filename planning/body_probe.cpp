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
    : field_(field),
      drive_(drive),
      body_(body),
      kinds_(std::move(kinds)),
      circles_(geometry::covering_circles(body, circle_count(body))),
      reach_m_(body.reach_m()) {}

std::size_t BodyProbe::segments() const {
  return std::max<std::size_t>(1, drive_.points().size() - 1);
}

geometry::TrajectoryPoint BodyProbe::state_at(std::size_t segment, double share) const {
  const auto& rows = drive_.points();
  return geometry::interpolate(rows[segment], rows[std::min(segment + 1, rows.size() - 1)], share);
}

double BodyProbe::motion_bound_m(const Span& span) const {
  const auto& rows = drive_.points();
  const geometry::TrajectoryPoint& a = rows[span.segment];
  const geometry::TrajectoryPoint& b = rows[std::min(span.segment + 1, rows.size() - 1)];
  const double way_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
  const double turn_rad = std::abs(b.heading_rad - a.heading_rad);
  constexpr double rounding_m = 1e-8;  // of coordinates up to 10,000 km
  return 0.5 * (span.to - span.from) * (way_m + reach_m_ * turn_rad) + rounding_m;
}

double BodyProbe::lower_bound_m(const geometry::TrajectoryPoint& state) const {
  const Eigen::Vector2d axle(state.x_m, state.y_m);
  const Eigen::Vector2d forward(std::cos(state.heading_rad), std::sin(state.heading_rad));
  double least = field_.horizon_m();
  for (const double x_m : circles_.centres_x_m) {
    for (const map::ObstacleKind kind : kinds_) {
      least = std::min(least, field_.distance_bound_m(axle + x_m * forward, kind));
    }
  }
  return std::max(0.0, least - circles_.radius_m);
}

std::optional<map::ClearanceField::Nearest> BodyProbe::nearest(
    const geometry::TrajectoryPoint& state, double within_m) const {
  std::optional<map::ClearanceField::Nearest> least;
  for (const map::ObstacleKind kind : kinds_) {
    const auto found = field_.nearest(state.pose(), body_, within_m, kind);
    if (found && (!least || found->distance_m < least->distance_m)) least = found;
  }
  return least;
}

}  // namespace roadbed::planning
