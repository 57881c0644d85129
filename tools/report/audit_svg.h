#pragma once

#include <string>
#include <vector>

#include "roadbed/geometry/polygon.h"
#include "roadbed/geometry/trajectory.h"
#include "roadbed/geometry/vehicle_shape.h"
#include "roadbed/map/occupancy/clearance_field.h"
#include "roadbed/planning/audit.h"

namespace roadbed::tools {

/// What a picture of an audit shows, all in source coordinates.
struct AuditPicture {
  const geometry::Trajectory& drive;
  geometry::VehicleShape body;  ///< as audited, with its margin
  const planning::AuditReport& report;
  std::vector<map::Box2> occupied;    ///< of the height band; what is out of sight is left out
  std::vector<geometry::Ring> lanes;  ///< drivable lanes of a map; may be empty
};

/// The drive's footprints among the occupied cells, conflicts with their witnesses in red, times
/// over unknown space in violet; 900 wide, with a scale bar. Same input, same bytes.
std::string audit_svg(const AuditPicture& picture);

}  // namespace roadbed::tools
