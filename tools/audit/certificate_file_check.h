#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/tools/audit/certificate_json.h"
#include "roadbed/tools/cli/inputs.h"
#include "roadbed/tools/files/vehicle_json.h"

namespace roadbed::tools::inline audit {

/// What a certificate has to be about; what is not given may be anything. A file that is given is
/// also where the certificate's is read from: it is the same one if its hash is.
struct CertificateDemands {
  std::filesystem::path occupancy = {}, trajectory = {}, vehicle = {}, map = {}, obstacles = {};
  std::string ground = {};  ///< the words of `--ground`
  std::string on = {};      ///< those of `--on`
  std::optional<double> clearance_m = {}, inflate_m = {}, underside_m = {}, least_measured = {},
                        margin_m = {}, seam_m = {};
  std::optional<planning::UnknownPolicy> unknown = {};
};

/// Whether every claim of a certificate holds, by brute force, and it is about what is demanded;
/// what does not or is not is printed, with the files that were looked at and their hashes. All
/// that is claimed is taken from these files anew: the vehicle's parts and their heights, the
/// ground, dynamic obstacles, what was measured.
/// @throws InputError if the certificate, or what a file of the right hash holds, is unusable.
bool check_certificate_file(const std::filesystem::path& certificate,
                            const CertificateDemands& demands, bool json, const Inputs& inputs,
                            std::ostream& out);

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
