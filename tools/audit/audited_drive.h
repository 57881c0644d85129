#pragma once

#include <functional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/ground/measured_ground.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/vehicle_audit.h"
#include "roadbed/tools/audit/audit_subjects.h"

namespace roadbed::tools::inline audit {

/// What the heights of a vehicle are above: a level, the lanes of a map, or what was measured.
struct GroundRule {
  enum class Kind { level, map, measured };
  Kind kind = Kind::level;
  double level_m = 0.0;
  const map::RoadMap* road_map = nullptr;  ///< of Kind::map
  map::BodyReach body = {};                ///< of Kind::measured: what needs ground under it
};

/// What is wrong with the words of a rule: a height in metres, "map" or "measured"; nothing: all is
/// well.
std::string ground_rule_fault(const std::string& text);

/// The rule of words without a fault; of none it is that of the map if there is one, else level 0.
/// @pre there is a map where the words are "map".
GroundRule ground_rule(const std::string& text, const map::RoadMap* road_map);

/// What is asked of every drive.
struct AuditQuestion {
  geometry::VehicleShape shape;
  std::vector<geometry::BodyPart> parts;  ///< of the vehicle, without the margin
  GroundRule ground;
  planning::AuditOptions options;
  std::vector<planning::MovingObstacle> moving = {};  ///< in source coordinates
  std::size_t drives_at_once = 1;                     ///< that share the memory for fields

  /// From the lowest part's underside to the highest top.
  map::HeightBand heights(const planning::GroundUnder& under) const;
};

/// How far the vehicle reaches, with the margin.
map::BodyReach reach_of(const AuditQuestion& question);

/// What the vehicle of a question meets on a drive.
planning::VehicleSurroundings surroundings(const map::OccupancySource& occupancy,
                                           const geometry::Trajectory& drive,
                                           const planning::GroundUnder& ground,
                                           const AuditQuestion& question);

/// The ground under a drive by a question's rule.
/// @throws InputError if it cannot be told, or lies apart from all that was measured.
planning::GroundUnder ground_under(const map::OccupancySource& occupancy,
                                   const geometry::Trajectory& drive, const GroundRule& rule);

/// What heights are above, where that is no level, and whether cells of this size are too coarse
/// for it; in lines, none where there is nothing to say.
std::string ground_note(const planning::GroundUnder& ground, const AuditQuestion& question,
                        double cell_m);

/// The vehicle's parts as audited, with the margin.
std::vector<geometry::BodyPart> inflated_parts(const AuditQuestion& question);

/// The vehicle's rectangle grown by the margin on every side.
geometry::VehicleShape inflated_shape(const AuditQuestion& question);

/// A drive and what its audit found.
struct AuditedDrive {
  std::string name;
  std::string fault = {};  ///< why it could not be audited; empty: it was
  geometry::Trajectory drive = {};
  planning::GroundUnder ground = {};
  planning::AuditReport report = {};

  bool is_clear() const { return fault.empty() && report.verdict == planning::Verdict::clear; }
  /// "clear", "conflict", …, or "unusable".
  std::string_view outcome() const {
    return fault.empty() ? planning::name(report.verdict) : "unusable";
  }
};

/// Audits each drive by itself; one that is unusable does not stop the others. The same for any
/// number of threads. `done_one` is called in the threads.
std::vector<AuditedDrive> audit_all(const map::OccupancySource& occupancy,
                                    const std::vector<AuditSubject>& subjects,
                                    const AuditQuestion& question, int threads,
                                    const std::function<void()>& done_one);

}  // namespace roadbed::tools
