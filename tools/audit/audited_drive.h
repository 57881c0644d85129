#pragma once

#include <functional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/planning/audit/audit_drive.h"
#include "roadbed/tools/audit/audit_subjects.h"

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

/// A drive and what its audit found.
struct AuditedDrive {
  std::string name;
  std::string fault = {};  ///< why it could not be audited; empty: it was
  geometry::Trajectory drive = {};
  planning::DriveAudit audit = {};

  bool is_clear() const { return fault.empty() && audit.is_clear(); }
  /// "clear", "conflict", …, or "unusable".
  std::string_view outcome() const {
    return fault.empty() ? planning::to_string(audit.report.verdict) : "unusable";
  }
};

/// Audits each drive by itself; one that is unusable does not stop the others. The same for any
/// number of threads. `done_one` is called in the threads.
std::vector<AuditedDrive> audit_all(const map::OccupancySource& occupancy,
                                    const std::vector<AuditSubject>& subjects,
                                    const planning::AuditQuestion& question, int threads,
                                    const std::function<void()>& done_one);

}  // namespace roadbed::tools::audit
