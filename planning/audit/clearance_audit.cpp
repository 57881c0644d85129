#include "roadbed/planning/audit/clearance_audit.h"

#include <algorithm>
#include <cmath>

#include "roadbed/planning/audit/moving_probe.h"
#include "roadbed/planning/audit/part_audit.h"

namespace roadbed::planning::inline audit {

map::FieldRegion audited_region(const geometry::Trajectory& drive_in_source,
                                std::span<const geometry::BodyPart> parts,
                                const AuditOptions& options) {
  constexpr double least_horizon_m = 50.0;
  constexpr std::size_t most_cells = 40'000'000;  // however far apart the rows are
  double farthest_m = 0.0, radius_m = 0.0, circle_m = 0.0;
  for (const geometry::BodyPart& part : parts) {
    const geometry::BodyPart body = geometry::inflated(part, options.inflate_m);
    // The box around a circle, which unknown space is shared out in, reaches beyond it.
    const double box_m = std::sqrt(2.0) * body.radius_m;
    farthest_m = std::max({farthest_m, body.reach_m(), body.middle_in_vehicle().norm() + box_m});
    circle_m = std::max(circle_m, body.radius_m);
    radius_m = std::max(radius_m, std::sqrt(2.0) * body.circumradius_m());  // of the box around it
  }
  const Eigen::Vector2d reach_m = Eigen::Vector2d::Constant(farthest_m);
  const Eigen::Vector2d start = drive_in_source.points().front().pose().position();
  map::Box2 around{start, start};
  for (const geometry::TrajectoryPoint& point : drive_in_source.points()) {
    around.min_in_source = around.min_in_source.cwiseMin(point.pose().position());
    around.max_in_source = around.max_in_source.cwiseMax(point.pose().position());
  }
  around.min_in_source -= reach_m;
  around.max_in_source += reach_m;
  return {.around = around,
          .horizon_m = std::max(least_horizon_m, 3.0 * options.clearance_m) + circle_m,
          .body_radius_m = radius_m,
          .most_cells = most_cells};
}

AuditReport audit_clearance(const map::ClearanceField& field,
                            const geometry::Trajectory& drive_in_source,
                            const geometry::BodyPart& part, const AuditOptions& options,
                            std::span<const ObstacleInSource> moving_in_source) {
  std::optional<geometry::Trajectory> changed;
  if (!moving_in_source.empty())
    changed = with_samples_at_changes(drive_in_source, moving_in_source);
  const geometry::Trajectory& drive = changed ? *changed : drive_in_source;
  const PartInField whole{field, part};
  return judged(audit_parts({&whole, 1}, drive, options, moving_in_source).front(),
                drive_in_source);
}

}  // namespace roadbed::planning::audit
