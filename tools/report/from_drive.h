#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/planning/audit/audit.h"
#include "roadbed/tools/report/report.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline report {

/// What the report says besides the drive itself.
struct ReportContext {
  std::string command;  ///< line that makes the drive again
  std::string version;  ///< "roadbed 0.1.0"
  std::vector<ReportSource> sources;
  std::optional<planning::AuditReport> audit;  ///< none: no occupancy was given
};

/// Everything that the report shows of a closed-loop drive; the map and occupied space up to 150 m
/// and 60 m around it.
ReportInput report_of(const Scenario& scenario, const World& world, const Drive& drive,
                      const ReportContext& context);

/// Stretches of equal behaviour, each with the reason of its first cycle.
std::vector<ReportDecision> decisions_of(const Drive& drive);

}  // namespace roadbed::tools::report
