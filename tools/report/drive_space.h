#pragma once

#include <optional>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/audit/ground_under.h"

namespace roadbed::tools::inline report {

/// What a log of a drive shows besides what its page does.
struct DriveSpace {
  std::vector<geometry::BodyPart> parts = {};  ///< of the vehicle; empty: its rectangle
  const map::OccupancySource* occupancy = nullptr;
  const planning::GroundUnder* ground = nullptr;  ///< what everything stands on; null: level 0
  std::optional<planning::AuditReport> audit = {};
};

}  // namespace roadbed::tools::report
