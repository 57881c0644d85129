#pragma once

#include <string>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/audit/audit.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::tools::inline report {

/// What a picture of an audit shows, all in source coordinates.
struct AuditPicture {
  const geometry::Trajectory& drive;
  std::vector<geometry::BodyPart> parts;  ///< of the vehicle as audited, with their margin
  const planning::AuditReport& report;
  std::vector<map::Box2> occupied;    ///< of the height band; what is out of sight is left out
  std::vector<geometry::Ring> lanes;  ///< drivable lanes of a map; may be empty
  std::vector<planning::ObstacleInSource> moving = {};
};

/// The drive's footprints among the occupied cells, conflicts with their witnesses in red, times
/// over unknown space in violet; below them the clearance over time, up to 5 m, and a close-up of
/// where it is least. 900 wide, with a scale bar. Same input, same bytes.
std::string audit_svg(const AuditPicture& picture);

}  // namespace roadbed::tools::report
