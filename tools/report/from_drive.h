#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/planning/audit/clearance_audit.h"
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

/// What is checked of a drive: outcome, clearance, road, speed limit, accelerations, yaw rate; and
/// what is only noted: tracking errors, saturation, cycles without a plan. A drive with no row has
/// its outcome checked alone.
std::vector<ReportCheck> drive_checks(const Drive& drive,
                                      const std::optional<planning::AuditReport>& audit);

/// Speed, acceleration, curvature, lateral and heading error, and clearance over time. A clearance
/// of more than 5 m is a gap, so that the near ones can be told apart.
std::vector<ReportPlot> drive_plots(const Drive& drive,
                                    const std::optional<planning::AuditReport>& audit);

}  // namespace roadbed::tools::report
