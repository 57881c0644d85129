#pragma once

// Private to planning/audit.

#include <span>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline audit {

/// A part of a vehicle in the space of its heights.
struct PartInField {
  const map::ClearanceField& field;
  const geometry::BodyPart& part;
};

/// A report for each part, as `audit_clearance`, which see; whether enough was measured is not
/// judged yet. All that is asked about one stretch of the drive is asked together, so that parts
/// of one height share the tiles of their field.
/// @param drive_in_source  of `with_samples_at_changes`, where things move.
std::vector<AuditReport> audit_parts(std::span<const PartInField> parts,
                                     const geometry::Trajectory& drive_in_source,
                                     const AuditOptions& options,
                                     std::span<const ObstacleInSource> moving_in_source);

}  // namespace roadbed::planning::audit
