#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/audit/surface/surface_audit.h"
#include "roadbed/planning/rules/rule_audit.h"
#include "roadbed/tools/audit/kept_surfaces.h"
#include "roadbed/tools/cli/inputs.h"

namespace roadbed::tools::inline audit {

/// The words of `--on`: drivable, surface, lanes, a route's file, or an area's.
struct SurfaceWords {
  planning::SurfaceRule::Kind kind = planning::SurfaceRule::Kind::drivable;
  std::filesystem::path file = {};  ///< of a route or an area
};

/// What is wrong with the words; empty: nothing.
std::string surface_words_fault(const std::string& text);

/// @pre they have no fault
SurfaceWords surface_words(const std::string& text);

/// What is asked of a drive about the road.
struct RoadQuestion {
  std::string on;  ///< the words
  planning::SurfaceRule surface = {};
  /// Of a rule that asks for the same whatever the drive (an area, a route): made once. May be
  /// null.
  std::shared_ptr<const planning::RoadSurface> made = {};
  std::shared_ptr<KeptSurfaces> kept = std::make_shared<KeptSurfaces>();  ///< of other drives
  double margin_m = 0.0;
  std::vector<planning::LightCycle> lights = {};
  std::vector<planning::TrafficRule> counted = {};  ///< rules that count in the verdict
};

/// The rule of words, with the files that they name read.
/// @throws InputError if a file is unusable, or names a lane that the map does not have.
planning::SurfaceRule surface_rule(const std::string& words, const map::RoadMap* road_map);

/// The surface of a rule that does not depend on the drive; null for the others.
std::shared_ptr<const planning::RoadSurface> made_surface(const planning::SurfaceRule& rule);

/// What lights show, as far as files say: a CommonRoad map, a scenario (`.json`, `.xml`).
/// @param start_step  of CommonRoad, that is second 0 (`second_0_step`).
std::vector<planning::LightCycle> recorded_lights(const std::filesystem::path& file,
                                                  long start_step);

/// What was found of a drive about the road.
struct RoadAudit {
  std::string on;  ///< the words of the question
  double margin_m = 0.0, seam_m = 0.0;
  planning::SurfaceReport surface = {};
  std::vector<planning::SurfaceCertificate> certificates = {};
  std::vector<planning::RuleReport> rules = {};
  std::vector<planning::TrafficRule> counted = {};
  std::shared_ptr<const planning::RoadSurface> made = {};  ///< the surface near the drive, at least

  /// The gravest of the surface's and those of the rules that count.
  planning::Verdict verdict() const;
  bool counts(planning::TrafficRule rule) const;
};

/// @param parts  of the vehicle, with the margin around it.
RoadAudit audit_road(const geometry::Trajectory& drive_in_source,
                     std::span<const geometry::BodyPart> parts, const RoadQuestion& question,
                     bool certifies);

}  // namespace roadbed::tools::audit
