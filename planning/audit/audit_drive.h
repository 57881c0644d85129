#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/planning/audit/certificate.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/planning/audit/ground_under.h"
#include "roadbed/planning/audit/vehicle_audit.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline audit {

/// What is asked of a drive, or of each of many.
struct AuditQuestion {
  std::vector<geometry::BodyPart> parts;  ///< of the vehicle, without the margin
  GroundRule ground = {};
  AuditOptions options = {};
  std::vector<ObstacleInSource> moving_in_source = {};
  bool certifies = false;  ///< whether certificates are asked for as well

  /// From the lowest part's underside to the highest top.
  map::HeightBand heights(const GroundUnder& under) const;

  /// What the heights are above on a drive.
  /// @throws InputError if that cannot be told.
  GroundUnder ground_of(const map::OccupancySource& occupancy,
                        const geometry::Trajectory& drive_in_source) const;

  /// The parts as audited, with the margin.
  std::vector<geometry::BodyPart> inflated_parts() const;
};

/// What an audit found of a drive.
struct DriveAudit {
  GroundUnder ground = {};
  AuditReport report = {};                          ///< of the vehicle as a whole
  std::vector<AuditCertificate> certificates = {};  ///< of each part, where they were asked for

  bool is_clear() const { return report.verdict == Verdict::clear; }
};

/// Audits a drive from its beginning to its proof:
///
///     ground below it ─▶ occupied space around each part, by height ─▶ audit of each part
///                                                 report of the whole ◀──┴──▶ certificates
///
/// @param on_ground  called once the ground is known, which what comes then may take long for.
/// @throws InputError if the ground cannot be told, or there would be too many cells.
/// @throws std::invalid_argument as `audit_clearance`.
DriveAudit audit_drive(const map::OccupancySource& occupancy,
                       const geometry::Trajectory& drive_in_source, const AuditQuestion& question,
                       const std::function<void(const GroundUnder&)>& on_ground = {});

/// The same in what is around the question's parts over the ground: all of a region that the drive
/// keeps within.
DriveAudit audit_drive(const VehicleSurroundings& around, GroundUnder ground,
                       const geometry::Trajectory& drive_in_source, const AuditQuestion& question);

/// The same within one field for all parts, made of the heights that count. The ground is not asked
/// for, and nothing says why space is unobserved.
DriveAudit audit_drive(std::shared_ptr<const map::ClearanceField> field,
                       const geometry::Trajectory& drive_in_source, const AuditQuestion& question);

/// What an audit leaves of a drive that is a straight line, of which nobody says where it was, in
/// some stretches: these are unknown in its report and in its certificates, however clear the line.
/// @pre they lie in the drive, in order of time.
void leave_unknown(const std::vector<Stretch>& between_poses, DriveAudit& audit);

}  // namespace roadbed::planning::audit
