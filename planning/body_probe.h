#pragma once

// Private to planning: what the audit asks of a clearance field.

#include <optional>
#include <vector>

#include "roadbed/geometry/trajectory.h"
#include "roadbed/geometry/vehicle_shape.h"
#include "roadbed/map/occupancy/clearance_field.h"

namespace roadbed::planning {

/// A part of one segment of a drive, between two of its rows: `from`, `to` in 0 … 1.
struct Span {
  std::size_t segment = 0;
  double from = 0.0, to = 1.0;

  double middle() const { return 0.5 * (from + to); }
  Span first_half() const { return {segment, from, middle()}; }
  Span second_half() const { return {segment, middle(), to}; }
};

/// Distances from a body that drives along a trajectory to obstacles of given kinds.
class BodyProbe {
 public:
  BodyProbe(const map::ClearanceField& field, const geometry::Trajectory& drive,
            const geometry::VehicleShape& body, std::vector<map::ObstacleKind> kinds);

  std::size_t segments() const;  ///< at least one: a single row is a segment without motion
  geometry::TrajectoryPoint state_at(std::size_t segment, double share) const;
  geometry::TrajectoryPoint middle_of(const Span& span) const {
    return state_at(span.segment, span.middle());
  }

  /// No point of the body moves further than this between the span's middle and any other time of
  /// it: half the way of the axle plus half the turn times the body's reach, and rounding.
  double motion_bound_m(const Span& span) const;

  /// Lower bound of the distance at a state, by circles that cover the body. O(1).
  double lower_bound_m(const geometry::TrajectoryPoint& state) const;

  /// Exact distance; none if it is over `within_m` or the horizon.
  std::optional<map::ClearanceField::Nearest> nearest(const geometry::TrajectoryPoint& state,
                                                      double within_m) const;

  double horizon_m() const { return field_.horizon_m(); }

 private:
  const map::ClearanceField& field_;
  const geometry::Trajectory& drive_;
  geometry::VehicleShape body_;
  std::vector<map::ObstacleKind> kinds_;
  geometry::CoveringCircles circles_;
  double reach_m_;
};

}  // namespace roadbed::planning
