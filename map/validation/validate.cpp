#include "roadbed/map/validation/validate.h"

#include <algorithm>
#include <iterator>

#include "roadbed/map/validation/rules.h"

namespace roadbed::map {

std::string_view name(Severity severity) {
  switch (severity) {
    case Severity::info:
      return "info";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "error";
}

std::vector<Finding> validate(const RoadMap& road_map, const ValidateOptions& options) {
  using Rule = rules::Findings (*)(const RoadMap&, const ValidateOptions&);
  static constexpr Rule kRules[] = {
      rules::gaps,      rules::kinks,           rules::negative_widths,    rules::zero_widths,
      rules::folds,     rules::one_sided_links, rules::self_intersections, rules::zero_width_links,
      rules::dead_ends, rules::separate_parts,  rules::missing_speeds,     rules::import_remarks,
  };
  std::vector<Finding> findings;
  for (const Rule rule : kRules) {
    rules::Findings found = rule(road_map, options);
    std::move(found.begin(), found.end(), std::back_inserter(findings));
  }
  std::stable_sort(findings.begin(), findings.end(),
                   [](const Finding& a, const Finding& b) { return a.rule < b.rule; });
  return findings;
}

}  // namespace roadbed::map
