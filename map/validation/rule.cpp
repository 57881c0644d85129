#include "roadbed/map/validation/rule.h"

#include <fmt/format.h>

#include <algorithm>

#include "roadbed/map/validation/rules.h"
#include "roadbed/map/validation/source.h"

namespace roadbed::map {

std::vector<RuleInfo> rule_catalogue() {
  std::vector<RuleInfo> catalogue = rules::source_rule_infos();
  for (const rules::MapRule& rule : rules::map_rules()) catalogue.push_back(rule.info);
  for (const RuleInfo& rule : rules::import_rules()) catalogue.push_back(rule);
  std::sort(catalogue.begin(), catalogue.end(),
            [](const RuleInfo& a, const RuleInfo& b) { return a.id < b.id; });
  return catalogue;
}

namespace rules {

Finding& Report::add(std::string element, std::optional<Eigen::Vector2d> in_map,
                     std::string message) {
  Finding finding{.rule = std::string(rule_->id),
                  .asam_rule = std::string(rule_->asam_rule),
                  .severity = rule_->severity,
                  .element = std::move(element),
                  .line = 0,
                  .in_map = in_map,
                  .message = std::move(message)};
  if (++count_ > kMost) return uncounted_ = std::move(finding);
  return findings_->emplace_back(std::move(finding));
}

void Report::finish() {
  if (count_ <= kMost) return;
  uncounted_.element = "map";
  uncounted_.line = 0;
  uncounted_.in_map.reset();
  uncounted_.message = fmt::format("and {} more of this kind", count_ - kMost);
  findings_->push_back(std::move(uncounted_));
}

}  // namespace rules
}  // namespace roadbed::map
