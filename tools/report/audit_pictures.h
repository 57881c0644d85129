#pragma once

#include <functional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

/// What a picture of an audit shows, all in source coordinates.
struct AuditPicture {
  const geometry::Trajectory& drive;
  std::vector<geometry::BodyPart> parts;  ///< of the vehicle as audited, with their margin
  const planning::AuditReport& report;
  std::vector<map::Box2> occupied;    ///< of the height band; what is out of sight is left out
  std::vector<geometry::Ring> lanes;  ///< drivable lanes of a map; may be empty
  std::vector<planning::ObstacleInSource> moving = {};
  bool is_of_surface = false;  ///< distances are those to the edge of what the drive has to stay on
};

/// The drive's footprints among the occupied cells, conflicts with their witnesses in red, times
/// over unknown space in violet; below them the clearance over time, up to 5 m, where the report
/// has it, and a close-up of where it is least. 900 wide, with a scale bar. Same input, same bytes.
std::string audit_svg(const AuditPicture& picture);

/// What the close-ups of an audit show, all in source coordinates.
struct CloseUpScene {
  const geometry::Trajectory& drive;
  const std::vector<geometry::BodyPart>& parts;  ///< of the vehicle as audited, with the margin
  /// Boxes of the heights of the vehicle that meet a box, and others perhaps.
  const std::function<std::vector<map::Box2>(const map::Box2&)>& occupied_in;
  const std::vector<geometry::Ring>& lanes;  ///< of a map; may be empty
  const std::vector<planning::ObstacleInSource>& moving;
};

/// A picture for each conflict, at its least clearance: the vehicle with the part that is nearest,
/// the cell or moving thing that is in its way, and an arrow of their distance. Without a conflict
/// that of the least clearance of the drive; none where nothing is near. At most 24, in order of
/// time. Same input, same bytes.
std::vector<ReportPicture> close_ups(const planning::AuditReport& report,
                                     const CloseUpScene& scene);

}  // namespace roadbed::tools::report
