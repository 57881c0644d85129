#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/planning/audit/audit_drive.h"
#include "roadbed/tools/audit/road_audit.h"
#include "roadbed/tools/files/drive_file.h"

namespace roadbed::tools::inline audit {

/// What is wrong with the words of a rule: a height in metres, "map" or "measured"; nothing: all is
/// well.
std::string ground_rule_fault(const std::string& text);

/// The rule of words without a fault; of none it is that of the map if there is one, else level 0.
/// @pre there is a map where the words are "map".
planning::GroundRule ground_rule(const std::string& text, const map::RoadMap* road_map);

/// What heights are above, where that is no level, and whether cells of this size are too coarse
/// for it; in lines, none where there is nothing to say.
std::string ground_note(const planning::GroundUnder& ground,
                        const planning::AuditQuestion& question, double cell_m);

/// All that drives are audited for.
struct AuditDemand {
  const map::OccupancySource* occupancy = nullptr;  ///< null: the road only
  planning::AuditQuestion question = {};
  const RoadQuestion* road = nullptr;  ///< null: the occupancy only
};

/// A drive and what its audit found.
struct AuditedDrive {
  std::string name;
  std::string fault = {};  ///< why it could not be audited; empty: it was
  geometry::Trajectory drive = {};
  /// That its file names, if that was audited: "commonroad:3".
  std::string vehicle_of_drive = {};
  std::vector<std::string> notes = {};                ///< of its file, for users
  std::vector<planning::Stretch> between_poses = {};  ///< its log says no pose for long: unknown
  bool has_occupancy = true;                          ///< whether it was audited against one
  planning::DriveAudit audit = {};                    ///< against the occupancy
  std::optional<RoadAudit> road = {};

  /// What a file holds of it.
  void take(DriveOfFile read);

  bool is_clear() const { return outcome() == "clear"; }
  /// "clear", "conflict", …, the gravest of all that was asked, or "unusable".
  std::string_view outcome() const;

  /// What speaks against the drive, as one report: that of the occupancy, in which excursions from
  /// the surface are conflicts, their witness a point of its edge. Without an occupancy, clearances
  /// are distances to the edge.
  planning::AuditReport whole() const;
};

/// Audits a drive; `on_ground` as of `planning::audit_drive`.
/// @throws InputError and std::invalid_argument as that and `audit_road`.
void audit_one(const AuditDemand& demand, AuditedDrive& audited,
               const std::function<void(const planning::GroundUnder&)>& on_ground = {});

/// What is left to do once a drive was audited against the occupancy: stretches between poses are
/// unknown, and what a demand says of the road, if it does. Throws as `audit_road`.
void finish_audit(const AuditDemand& demand, AuditedDrive& audited);

}  // namespace roadbed::tools::audit
