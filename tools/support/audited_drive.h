#pragma once

#include <functional>
#include <string>
#include <vector>

#include "roadbed/geometry/trajectory.h"
#include "roadbed/geometry/vehicle_shape.h"
#include "roadbed/map/occupancy/clearance_field.h"
#include "roadbed/map/occupancy/occupancy_map.h"
#include "roadbed/planning/audit.h"
#include "roadbed/tools/support/audit_subjects.h"

namespace roadbed::tools {

/// What is asked of every drive.
struct AuditQuestion {
  geometry::VehicleShape vehicle;
  map::HeightBand band;
  planning::AuditOptions options;
  std::vector<planning::MovingObstacle> moving = {};  ///< in source coordinates
};

/// A drive and what its audit found.
struct AuditedDrive {
  std::string name;
  std::string fault = {};  ///< why it could not be audited; empty: it was
  geometry::Trajectory drive = {};
  planning::AuditReport report = {};

  bool is_clear() const { return fault.empty() && report.verdict == planning::Verdict::clear; }
  /// "clear", "conflict", …, or "unusable".
  std::string_view outcome() const {
    return fault.empty() ? planning::name(report.verdict) : "unusable";
  }
};

/// Audits each drive by itself; one that is unusable does not stop the others. The same for any
/// number of threads. `done_one` is called in the threads.
std::vector<AuditedDrive> audit_all(const map::OccupancyMap& occupancy,
                                    const std::vector<AuditSubject>& subjects,
                                    const AuditQuestion& question, int threads,
                                    const std::function<void()>& done_one);

}  // namespace roadbed::tools
