#pragma once

#include <optional>
#include <vector>

#include "roadbed/planning/audit/audit.h"
#include "roadbed/tools/report/report.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools::inline report {

/// What is checked of a drive: outcome, clearance, road, speed limit, accelerations, yaw rate; and
/// what is only noted: tracking errors, saturation, cycles without a plan. A drive with no row has
/// its outcome checked alone.
std::vector<ReportCheck> drive_checks(const Drive& drive,
                                      const std::optional<planning::AuditReport>& audit);

}  // namespace roadbed::tools
