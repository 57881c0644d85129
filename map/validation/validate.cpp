#include "roadbed/map/validation/validate.h"

#include <algorithm>
#include <utility>

#include "roadbed/map/validation/rules.h"

namespace roadbed::map::validation {

std::vector<Finding> validate(const RoadMap& road_map, const ValidateOptions& options) {
  std::vector<Finding> findings;
  for (const MapRule& rule : map_rules()) {
    Report report(rule.info, findings);
    rule.check(road_map, options, report);
    report.finish();
  }
  for (Finding& remark : import_diagnostics(road_map)) findings.push_back(std::move(remark));
  std::ranges::stable_sort(findings, {}, &Finding::rule);
  return findings;
}

}  // namespace roadbed::map::validation
