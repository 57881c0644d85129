#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

/// What the page of an audit shows besides the audit itself, all in source coordinates.
struct AuditSurroundings {
  std::string name;                       ///< of the drive
  geometry::VehicleShape body;            ///< the rectangle of the vehicle, with its margin
  std::vector<geometry::BodyPart> parts;  ///< as audited, with the margin
  double clearance_m = 0.0;               ///< asked for
  bool is_of_surface = false;  ///< distances are those to the edge of what the drive has to stay on
  std::vector<map::Box2> occupied;
  std::shared_ptr<const map::RoadMap> road_map;  ///< near the drive; none: no map was given
  std::vector<planning::ObstacleInSource> moving;
  std::vector<ReportCheck> checks;  ///< of what else was asked
  std::vector<DriveEvent> events;   ///< the same
  std::string command, version, crs;
  std::vector<ReportSource> sources;
};

/// A page that plays an audited drive: clearance and speed along the way, a bar with the verdict of
/// each stretch, an event where each conflict begins and where it is nearest.
ReportInput report_of_audit(const geometry::Trajectory& drive, const planning::AuditReport& report,
                            const AuditSurroundings& around);

/// A page that plays a drive that was recorded, as far as it tells of itself: speed with the limits
/// of the map, accelerations and curvature (`derived_dynamics.h`), what passengers bear; and what
/// its audit found.
/// @param report  none: it was not audited.
ReportInput report_of_recording(const geometry::Trajectory& drive,
                                const std::optional<planning::AuditReport>& report,
                                const AuditSurroundings& around);

/// An audited drive, as a page of many lists it.
struct IndexedAudit {
  std::string name;
  Tone tone = Tone::open;
  std::string outcome;  ///< "clear", "conflict", …, "unusable"
  std::string least;    ///< "0.31 m at 4.20 s, left side"; empty if it is unusable
  std::string text;     ///< all that is to be said, lines
  std::vector<ReportPicture> pictures;
};

/// One HTML page of all audits: a table that is sorted and chosen from by verdict, and leads to
/// what was found in each, with its close-ups. It needs no other file and no network. Same input,
/// same bytes.
/// @param occupancy  the name of its file; `version` of the program.
std::string audit_index_html(const std::vector<IndexedAudit>& audits, const std::string& occupancy,
                             const std::string& version);

}  // namespace roadbed::tools::report
