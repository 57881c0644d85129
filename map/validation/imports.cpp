#include "roadbed/map/validation/rules.h"

namespace roadbed::map::rules {

Findings import_remarks(const RoadMap& road_map, const ValidateOptions&) {
  Findings findings;
  for (const ImportRemark& remark : road_map.remarks()) {
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

}  // namespace roadbed::map::rules
