#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/audit/audit.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline simulation {

/// What `metrics.json` holds: the verdict, extremes of speed, acceleration and tracking errors with
/// their units in the keys, time per behaviour, and the audit. See the table in this folder's
/// README. What was not measured is null.
nlohmann::ordered_json metrics_of(const Scenario& scenario, const World& world, const Drive& drive,
                                  const std::optional<planning::AuditReport>& audit);

/// The least of a time between two that drive [s], and when.
struct SafetyMetric {
  double time_s = 0.0;
  double at_s = 0.0;
};

/// Least time to collision of a drive, as nuPlan takes it: from each row on everybody keeps speed
/// and heading, looked at every 0.1 s over 3 s. None: nothing would be touched.
std::optional<SafetyMetric> least_time_to_collision(const Drive& drive, const World& world,
                                                    const geometry::VehicleShape& vehicle);

/// Least time headway to a lead: gap over own speed, where that is 1 m/s or more. None: no lead.
std::optional<SafetyMetric> least_headway(const Drive& drive);

/// Metres driven against the reference line.
double wrong_way_m(const Drive& drive);

}  // namespace roadbed::tools::simulation
