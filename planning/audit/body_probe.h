#pragma once

// Private to planning/audit: what the audit asks of a clearance field.

#include <optional>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/audit/clearance_probe.h"

namespace roadbed::planning::inline audit {

/// Distances from a part of a vehicle that drives along a trajectory to obstacles of given kinds.
class BodyProbe : public ClearanceProbe {
 public:
  BodyProbe(const map::ClearanceField& field, const geometry::Trajectory& drive,
            const geometry::BodyPart& part, std::vector<map::ObstacleKind> kinds);

  /// By a circle around the part, then by several that cover it. O(1).
  double lower_bound_m(const Span& span, double enough_m) const override;
  std::optional<Near> nearest(const Span& span, double within_m) const override;
  /// By the rectangle, turned as the body is in the middle, that the body stays in all along. Where
  /// the body passes by a thing, that is nearly as far away as the body. Of spans that make it
  /// larger than the field is made for, nothing. O(segments).
  double swept_bound_m(const Span& span, double within_m) const override;
  double horizon_m() const override { return field_.horizon_m() - part_.radius_m; }
  bool is_continuous() const override { return true; }

 private:
  double field_bound_m(const Eigen::Vector2d& point) const;

  const map::ClearanceField& field_;
  geometry::BodyPart part_;
  std::vector<map::ObstacleKind> kinds_;
  Eigen::Vector2d middle_in_vehicle_;  // of the circle around the part
  double radius_m_;
  geometry::CoveringCircles circles_;  // along x, beside its middle line
};

}  // namespace roadbed::planning::audit
