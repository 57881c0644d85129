#pragma once

#include <span>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/audit/proven_span.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline audit {

/// A part of a drive by time, and what holds in all of it.
struct ProvenTime {
  double from_s = 0.0, to_s = 0.0;
  double at_least_m = 0.0;  ///< no time of it is nearer to an obstacle that moves
};

/// Everything that another program needs to convince itself of an audit's verdict: at the middle of
/// a proven span the distance is so large that the body cannot come nearer than `at_least_m` while
/// it moves through the span. What the spans leave out is in the stretches.
struct AuditCertificate {
  geometry::BodyPart part;  ///< of the vehicle, without the margin
  map::HeightBand band;
  double clearance_m = 0.0, inflate_m = 0.0;
  UnknownPolicy unknown_policy = UnknownPolicy::report;

  Verdict verdict = Verdict::undecided;
  /// Least of the spans that keep away from obstacles; 0 where some of the drive has none, or was
  /// not looked at.
  double certified_clearance_m = 0.0;

  std::vector<ProvenSpan> from_occupied;     ///< in order of time; over `clearance_m`, and over 0
  std::vector<ProvenSpan> from_unknown;      ///< empty where unknown space counts as free
  std::vector<ProvenTime> from_moving = {};  ///< the same; empty where nothing moves
  std::vector<ObservedTime> observed = {};   ///< where anything was looked at, in order of time
  double measured_fraction = 1.0;  ///< of the space that the part sweeps over: AuditReport
  std::vector<Conflict> conflicts;
  std::vector<Stretch> unknown;
  std::vector<Stretch> undecided;
};

/// The certificate of an audit's report. Spans reach up to 0.02 m below the least clearance, so
/// that they are few.
/// @pre `report` is what `audit` says of the same field, drive, part, options and obstacles.
AuditCertificate certify(const map::ClearanceField& field, const map::HeightBand& band,
                         const geometry::Trajectory& drive_in_source,
                         const geometry::BodyPart& part, const AuditOptions& options,
                         const AuditReport& report,
                         std::span<const ObstacleInSource> moving_in_source = {});

/// The same for a vehicle's rectangle.
inline AuditCertificate certify(const map::ClearanceField& field, const map::HeightBand& band,
                                const geometry::Trajectory& drive_in_source,
                                const geometry::VehicleShape& vehicle, const AuditOptions& options,
                                const AuditReport& report,
                                std::span<const ObstacleInSource> moving_in_source = {}) {
  return certify(field, band, drive_in_source, geometry::body_of(vehicle), options, report,
                 moving_in_source);
}

}  // namespace roadbed::planning::audit
