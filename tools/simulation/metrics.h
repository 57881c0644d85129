#pragma once

#include <nlohmann/json.hpp>
#include <optional>

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

}  // namespace roadbed::tools
