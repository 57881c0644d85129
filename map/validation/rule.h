#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/validation/finding.h"

namespace roadbed::map {

/// What a rule is for. Ids are stable: they are what users filter by.
struct RuleInfo {
  std::string_view id;         ///< "geometry.gap"
  std::string_view asam_rule;  ///< "asam.net:xodr:…", empty where ASAM has none
  Severity severity;           ///< the usual one; a finding may be graver or milder
  std::string_view meaning;    ///< what is wrong where the rule finds something, in one line
};

/// Every rule, those of the sources and of the readers too, in order of id.
std::vector<RuleInfo> rule_catalogue();

namespace rules {

/// Takes the findings of one rule; a file can be made to have more than memory holds, so those
/// past the first thousand are only counted, which a last finding says.
class Report {
 public:
  Report(const RuleInfo& rule, std::vector<Finding>& findings)
      : rule_(&rule), findings_(&findings) {}

  /// @param message  what was found, what is needed, what to do.
  /// @returns the finding, for what is particular about it; valid until the next one is added.
  Finding& add(std::string element, std::optional<Eigen::Vector2d> in_map, std::string message);

  /// To be called when the rule is through: says how many findings were only counted.
  void finish();

  static constexpr std::size_t kMost = 1000;

 private:
  const RuleInfo* rule_;
  std::vector<Finding>* findings_;
  std::size_t count_ = 0;
  Finding uncounted_;  ///< stands for those past the most
};

}  // namespace rules
}  // namespace roadbed::map
