#pragma once

#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/audit/audit.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

/// What the page of an audit shows besides the audit itself, all in source coordinates.
struct AuditSurroundings {
  std::string name;                       ///< of the drive
  geometry::VehicleShape body;            ///< the rectangle of the vehicle, with its margin
  std::vector<geometry::BodyPart> parts;  ///< as audited, with the margin
  double clearance_m = 0.0;               ///< asked for
  std::vector<map::Box2> occupied;
  std::vector<ReportLane> lanes;
  std::vector<planning::ObstacleInSource> moving;
  std::string command, version, crs;
  std::vector<ReportSource> sources;
};

/// A page that plays an audited drive: clearance and speed along the way, a bar with the verdict of
/// each stretch, an event where each conflict begins and where it is nearest.
ReportInput report_of_audit(const geometry::Trajectory& drive, const planning::AuditReport& report,
                            const AuditSurroundings& around);

}  // namespace roadbed::tools::report
