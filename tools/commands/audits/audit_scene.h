#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/tools/audit/audited_drive.h"
#include "roadbed/tools/audit/certificate_json.h"
#include "roadbed/tools/cli/command.h"
#include "roadbed/tools/commands/audits/audit_asked.h"
#include "roadbed/tools/report/audit_pages.h"
#include "roadbed/tools/report/drive_space.h"

namespace roadbed::tools::inline commands::inline audits {

/// What all drives are audited against.
struct AuditScene {
  const AuditAsked& asked;
  std::shared_ptr<const Inputs> inputs;
  planning::AuditQuestion question = {};
  geometry::VehicleShape shape = {};
  std::string vehicle_note = {};  ///< a line on the vehicle given, if it is not the drive's own
  std::shared_ptr<const map::OccupancySource> occupancy = nullptr;  ///< null: the road only
  std::shared_ptr<const map::RoadMap> road_map = nullptr;
  std::optional<RoadQuestion> road = {};  ///< none: the occupancy only
  std::string command = {};               ///< line that asks it again
  std::filesystem::path drive_file = {};  ///< of the one drive; empty: it is of no file

  std::string crs() const;
  AuditDemand demand() const;
};

/// The question with vehicle, map and road, read from the files that were asked for; not the
/// occupancy.
/// @throws InputError
AuditScene audit_scene(const AuditAsked& asked, bool certifies, const CommonOptions& common);

/// Reads the occupancy that was asked for, if any; says what there is to know of it.
/// @throws InputError if it is unusable, or apart from the roads of the map.
void add_occupancy(AuditScene& scene, const Streams& streams, const CommonOptions& common);

/// What a picture of a drive can show.
map::Box2 drawn(const AuditedDrive& audited, const AuditScene& scene);

/// What the page of a drive shows around it, and what was asked besides its clearance.
AuditSurroundings surroundings_of(const AuditedDrive& audited, const AuditScene& scene);

/// What the log of a drive shows besides.
/// @pre the scene stays as long as the space
DriveSpace space_of(const AuditedDrive& audited, const AuditScene& scene);

/// A file by its hash, taken once for many audits.
CertifiedFile hashed_once(const AuditScene& scene, const std::filesystem::path& file);

}  // namespace roadbed::tools::commands::audits
