#pragma once

#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/tools/audit/certificate_json.h"
#include "roadbed/tools/files/vehicle_json.h"

namespace roadbed::tools::inline audit {

/// What of the question that a certificate answers is not what its files say, a line each: the
/// parts of the vehicle, and the heights that they take.
std::vector<std::string> part_faults(const CertificateFile& file, const Vehicle& vehicle);

/// The same of the ground below, which is compared with the map's lanes or with what was measured.
/// @param road_map  null where none is named.
/// @param cells     all those within 2 m of the vehicle's way, at least.
std::vector<std::string> ground_faults_of(const CertificateFile& file,
                                          const geometry::Trajectory& drive,
                                          const map::RoadMap* road_map,
                                          const std::vector<map::OccupancyCell>& cells,
                                          double cell_m);

}  // namespace roadbed::tools::audit
