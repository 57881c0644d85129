#pragma once

#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/certificate.h"

namespace roadbed::planning::inline audit {

/// What of a certificate does not hold for an occupancy and a drive, a line each, at most ten;
/// nothing if all of it holds.
///
/// Shares no code with the audit: distances are brute force, from the vehicle's rectangle at the
/// middle of each span to every occupied box of the band, and to every column of it that was not
/// measured over its whole height. Undecided stretches claim nothing; that a stretch is unknown is
/// checked only in so far as all the rest is proven to be measured.
///
/// Obstacles that move are looked at one by one: at the middle of each span all that are there at
/// some time of it, at least as far away as the span promises plus what they and the body may move.
///
/// Cost: O(spans × boxes). Memory: of the columns within reach of the drive, 4 bytes each.
std::vector<std::string> check_certificate(const AuditCertificate& certificate,
                                           const std::vector<map::OccupancyCell>& cells,
                                           double resolution_m,
                                           const geometry::Trajectory& drive_in_source,
                                           std::span<const ObstacleInSource> moving_in_source = {});

/// How far from the way of the vehicle's axle cells matter to the check.
double checked_distance_m(const AuditCertificate& certificate,
                          const geometry::Trajectory& drive_in_source);

}  // namespace roadbed::planning::audit
