#pragma once

#include <optional>
#include <vector>

#include "roadbed/planning/audit/audit.h"
#include "roadbed/tools/report/report.h"
#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools::inline report {

/// Speed, acceleration, curvature, lateral and heading error, and clearance over time. A clearance
/// of more than 5 m is a gap, so that the near ones can be told apart.
std::vector<ReportPlot> drive_plots(const Drive& drive,
                                    const std::optional<planning::AuditReport>& audit);

}  // namespace roadbed::tools
