#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/planning/audit.h"

namespace roadbed::tools {

/// An audit as `audit --json` prints it: `{"verdict":…,"least_clearance_m":…,"unknown_share":…,
/// "conflicts":[…],…}`, without the profile.
nlohmann::ordered_json audit_json(const planning::AuditReport& report);

/// An audit for people: the verdict, the figures, and a line for every stretch that is not clear.
std::string audit_text(const planning::AuditReport& report);

}  // namespace roadbed::tools
