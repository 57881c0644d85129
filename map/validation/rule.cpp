#include "roadbed/map/validation/rule.h"

#include <fmt/format.h>

#include <utility>

namespace roadbed::map::validation {

std::string_view to_string(Severity severity) {
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

std::string Report::autoware_issue(int number) const {
  return fmt::format("{}-{:03}", rule_->autoware_rule, number);
}

void Report::finish() {
  if (count_ <= kMost) return;
  uncounted_.element = "map";
  uncounted_.line = 0;
  uncounted_.in_map.reset();
  uncounted_.message = fmt::format("and {} more of this kind", count_ - kMost);
  findings_->push_back(std::move(uncounted_));
}

}  // namespace roadbed::map::validation
