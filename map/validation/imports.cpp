#include <array>

#include "roadbed/map/validation/rules.h"

namespace roadbed::map::validation {
namespace {

constexpr std::array<RuleInfo, 2> kImportRules = {{
    {"import.refused", {}, Severity::error, "the file cannot be read as a map"},
    {"import.…",
     {},
     Severity::warning,
     "what a reader mended, left out or does not use, each under a name of its own; a note where "
     "the file is not at fault"},
}};

}  // namespace

std::vector<Finding> import_diagnostics(const RoadMap& road_map) {
  std::vector<Finding> findings;
  for (const ImportDiagnostic& remark : road_map.remarks()) {
    findings.push_back({.rule = remark.rule,
                        .asam_rule = {},
                        .severity = remark.is_fault ? Severity::warning : Severity::info,
                        .element = remark.element,
                        .line = remark.line,
                        .in_map = std::nullopt,
                        .message = remark.message});
  }
  return findings;
}

std::span<const RuleInfo> import_rules() { return kImportRules; }

}  // namespace roadbed::map::validation
