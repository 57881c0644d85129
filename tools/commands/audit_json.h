#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/planning/audit/audit.h"
#include "roadbed/tools/audit/audited_drive.h"
#include "roadbed/tools/report/audit_index.h"

namespace roadbed::tools::inline commands {

/// An audit as `audit --json` prints it: `{"verdict":…,"least_clearance_m":…,"unknown_share":…,
/// "conflicts":[…],"stretches":[…],…}`, without the profile.
nlohmann::ordered_json audit_json(const AuditedDrive& audited);

/// An audit for people: the verdict, the figures, and a line for every stretch that is not clear.
std::string audit_text(const planning::AuditReport& report);

/// `{"verdict":…,"counts":{…},"audits":[…]}`: each audit as above with the name of its drive, or
/// why there is none. The verdict is the gravest.
nlohmann::ordered_json audits_json(const std::vector<AuditedDrive>& audits);

/// What a page of many audits says of one, without pictures.
IndexedAudit indexed(const AuditedDrive& audited);

/// A line per drive, and one with the counts.
std::string audits_table(const std::vector<AuditedDrive>& audits);

}  // namespace roadbed::tools::commands
