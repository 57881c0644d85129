#pragma once

#include <string>
#include <vector>

#include "roadbed/tools/audit/audited_drive.h"

// Audits in the forms that other programs read.

namespace roadbed::tools::inline commands {

/// A test case per drive: failed where the drive is not clear, an error where it is unusable.
std::string audits_junit(const std::vector<AuditedDrive>& audits, const std::string& occupancy);

/// A line per stretch of one verdict, and for each conflict the vehicle's outline (with its
/// margin) where it is nearest, and the witness. Coordinates are the source's; `crs` names them.
std::string audits_geojson(const std::vector<AuditedDrive>& audits,
                           const planning::AuditQuestion& question, const std::string& crs);

}  // namespace roadbed::tools::commands
