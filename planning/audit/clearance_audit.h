#pragma once

#include <span>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline audit {

/// Whether a part of a vehicle keeps clear of occupied space on a drive, at every time between its
/// samples too: x, y and the unwrapped heading are linear between samples, and a motion bound
/// (README.md, "The proof") covers every point of the body. A `clear` is a proof; there is no
/// sampling step. Nor is there one without a measured cell of the part's heights near all along.
///
/// Obstacles that move are linear between their samples as well. They are told from occupied cells
/// in conflicts, which may overlap in time.
///
/// Cost: some lookups a sample where there is room, more where it is narrow.
/// @throws std::invalid_argument if the drive is empty, an option is negative or not finite, or the
///         vehicle leaves the region that the field was made for.
AuditReport audit_clearance(const map::ClearanceField& field,
                            const geometry::Trajectory& drive_in_source,
                            const geometry::BodyPart& part, const AuditOptions& options = {},
                            std::span<const ObstacleInSource> moving_in_source = {});

/// The same for a vehicle's rectangle.
inline AuditReport audit_clearance(const map::ClearanceField& field,
                                   const geometry::Trajectory& drive_in_source,
                                   const geometry::VehicleShape& vehicle,
                                   const AuditOptions& options = {},
                                   std::span<const ObstacleInSource> moving_in_source = {}) {
  return audit_clearance(field, drive_in_source, geometry::body_of(vehicle), options,
                         moving_in_source);
}

/// The part of an occupancy that matters to the audit of a drive: wherever the inflated parts may
/// be, with a horizon of 50 m, or more where the clearance or a circle asks for it.
map::FieldRegion audited_region(const geometry::Trajectory& drive_in_source,
                                std::span<const geometry::BodyPart> parts,
                                const AuditOptions& options);

/// The same for a vehicle's rectangle.
inline map::FieldRegion audited_region(const geometry::Trajectory& drive_in_source,
                                       const geometry::VehicleShape& vehicle,
                                       const AuditOptions& options) {
  const geometry::BodyPart body = geometry::body_of(vehicle);
  return audited_region(drive_in_source, {&body, 1}, options);
}

}  // namespace roadbed::planning::audit
