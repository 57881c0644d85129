#pragma once

#include <optional>
#include <vector>

#include "roadbed/planning/audit/audit.h"
#include "roadbed/tools/report/report.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools::inline report {

// What passengers bear, from nuPlan's comfort metrics (motional/nuplan-devkit,
// ego_is_comfortable.yaml).
inline constexpr double kLeastAcceleration_mps2 = -4.05;
inline constexpr double kMostAcceleration_mps2 = 2.40;
inline constexpr double kMostLateralAcceleration_mps2 = 4.89;
inline constexpr double kMostYawRate_radps = 0.95;

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
