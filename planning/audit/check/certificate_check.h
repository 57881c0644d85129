#pragma once

#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/ground/drive_ground.h"
#include "roadbed/map/occupancy/ground/ground.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
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

/// What speaks against places of ground that a certificate has from a map; nothing if each plane is
/// that of a lane there, within 1 mm of height and a thousandth of slope, and one follows the other
/// on one road from the drive's start to its end.
///
/// Shares no code with `road_under`: lanes are looked at one by one, segment by segment.
/// O(places × segments of the lanes within 20 m).
std::string map_ground_fault(const std::vector<map::GroundPlace>& places,
                             const map::RoadMap& road_map,
                             const geometry::Trajectory& drive_in_source);

/// What speaks against places of ground that a certificate has from an occupancy; nothing if at
/// each the lowest occupied cells of the columns within 2 m say so: next to none is below the
/// plane, on all four sides of the drive's direction about half are on it, to a cell, on one level,
/// and their mean is within a fifth of a cell of it. All of the body has a place within 2 m.
///
/// Shares no code with `measured_under`. O(cells + places × columns within 2 m).
std::string measured_ground_fault(const std::vector<map::GroundPlace>& places,
                                  const std::vector<map::OccupancyCell>& cells, double cell_m,
                                  const geometry::Trajectory& drive_in_source,
                                  const map::BodyReach& body);

}  // namespace roadbed::planning::audit
