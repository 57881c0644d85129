#include "roadbed/map/validation/validate.h"

#include <algorithm>
#include <array>

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

/// What the reader of the file has seen, under the reader's own rule names.
Finding finding_of(const ImportDiagnostic& remark) {
  return {.rule = remark.rule,
          .asam_rule = {},
          .severity = remark.is_fault ? Severity::warning : Severity::info,
          .element = remark.element,
          .line = remark.line,
          .in_map = std::nullopt,
          .message = remark.message};
}

}  // namespace

std::vector<Finding> validate(const RoadMap& road_map, const ValidateOptions& options) {
  std::vector<Finding> findings = findings_of(map_rules(), road_map, options);
  for (const ImportDiagnostic& remark : road_map.import_diagnostics())
    findings.push_back(finding_of(remark));
  std::ranges::stable_sort(findings, {}, &Finding::rule);
  return findings;
}

std::span<const RuleInfo> import_rules() { return kImportRules; }

}  // namespace roadbed::map::validation
