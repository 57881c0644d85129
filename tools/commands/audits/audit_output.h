#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/tools/audit/audited_drive.h"
#include "roadbed/tools/report/audit_pages.h"

namespace roadbed::tools::inline commands::inline audits {

// Audits in the forms that people and other programs read.

/// An audit as `audit --json` prints it: `{"verdict":…,"least_clearance_m":…,"unknown_share":…,
/// "conflicts":[…],"stretches":[…],…}`, without the profile.
nlohmann::ordered_json audit_json(const AuditedDrive& audited);

/// An audit for people: the verdict, the figures, and a line for every stretch that is not clear.
std::string audit_text(const AuditedDrive& audited);

/// The same of the surface, and of one rule.
std::string surface_text(const RoadAudit& road);
std::string rule_text(const planning::RuleReport& rule, bool counts);

/// The least clearance, or without an occupancy the least margin to the edge, in a line.
std::string least_text(const AuditedDrive& audited);

/// `{"verdict":…,"counts":{…},"audits":[…]}`: each audit as above with the name of its drive, or
/// why there is none. The verdict is the gravest.
nlohmann::ordered_json audits_json(const std::vector<AuditedDrive>& audits);

/// What a page of many audits says of one, without pictures.
IndexedAudit indexed(const AuditedDrive& audited);

/// A line per drive, and one with the counts.
std::string audits_table(const std::vector<AuditedDrive>& audits);

/// A test case per drive: failed where the drive is not clear, an error where it is unusable. Of a
/// drive that was asked about the road further ones: for the surface, and for each rule.
/// @param name  of what drives were audited against.
std::string audits_junit(const std::vector<AuditedDrive>& audits, const std::string& name);

/// A line per stretch of one verdict, and for each conflict the vehicle's outline (with its
/// margin) where it is nearest, and the witness. Coordinates are the source's; `crs` names them.
std::string audits_geojson(const std::vector<AuditedDrive>& audits,
                           const planning::AuditQuestion& question, const std::string& crs);

}  // namespace roadbed::tools::commands::audits
