#include "roadbed/planning/probe.h"

#include <algorithm>
#include <cmath>

namespace roadbed::planning {

std::size_t Probe::segments() const { return std::max<std::size_t>(1, drive_.points().size() - 1); }

geometry::TrajectoryPoint Probe::state_at(std::size_t segment, double share) const {
  const auto& rows = drive_.points();
  return geometry::interpolate(rows[segment], rows[std::min(segment + 1, rows.size() - 1)], share);
}

double Probe::time_at(std::size_t segment, double share) const {
  const auto& rows = drive_.points();
  const double from_s = rows[segment].t_s;
  return from_s + share * (rows[std::min(segment + 1, rows.size() - 1)].t_s - from_s);
}

std::size_t Probe::next_after(std::size_t segment, double spare_m) const {
  ++segment;
  if (!is_continuous()) return segment;
  for (; segment < segments(); ++segment) {
    spare_m -= 2.0 * motion_bound_m({segment, 0.0, 1.0});
    if (!(spare_m >= 0.0)) break;
  }
  return segment;
}

geometry::Pose2 Probe::middle_pose_of(const Span& span) const {
  const auto& rows = drive_.points();
  const geometry::TrajectoryPoint& a = rows[span.segment];
  const geometry::TrajectoryPoint& b = rows[std::min(span.segment + 1, rows.size() - 1)];
  const double share = span.middle();
  return {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m),
          a.heading_rad + share * (b.heading_rad - a.heading_rad)};
}

double Probe::motion_bound_m(const Span& span) const {
  const auto& rows = drive_.points();
  const geometry::TrajectoryPoint& a = rows[span.segment];
  const geometry::TrajectoryPoint& b = rows[std::min(span.segment + 1, rows.size() - 1)];
  const double dx_m = b.x_m - a.x_m, dy_m = b.y_m - a.y_m;
  const double way_m = std::sqrt(dx_m * dx_m + dy_m * dy_m);
  const double turn_rad = std::abs(b.heading_rad - a.heading_rad);
  constexpr double rounding_m = 1e-8;  // of coordinates up to 10,000 km
  return 0.5 * (span.to - span.from) * (way_m + reach_m_ * turn_rad) + rounding_m;
}

}  // namespace roadbed::planning
