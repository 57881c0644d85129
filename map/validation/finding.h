#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

namespace roadbed::map::validation {

enum class Severity { info, warning, error };
std::string_view to_string(Severity severity);

/// One fault of a map: what, where, and what to do.
struct Finding {
  std::string rule;       ///< "geometry.gap"
  std::string asam_rule;  ///< "asam.net:xodr:1.7.0:…", empty where there is none
  Severity severity = Severity::warning;
  std::string element;  ///< "road 12", "lane 12/0/-1"
  long line = 0;        ///< in the source file, 0 if unknown
  std::optional<Eigen::Vector2d> in_map;
  std::string message;              ///< with what to do
  std::string autoware_issue = {};  ///< "Lane.BorderSharing-001", empty where there is none
};

/// What a rule is for. Ids are stable: they are what users filter by.
struct RuleInfo {
  std::string_view id;                  ///< "geometry.gap"
  std::string_view asam_rule;           ///< "asam.net:xodr:…", empty where ASAM has none
  Severity severity;                    ///< the usual one; a finding may be graver or milder
  std::string_view meaning;             ///< what is wrong where it finds something, in one line
  std::string_view autoware_rule = {};  ///< "Lane.BorderSharing", the issues' name without number
};

}  // namespace roadbed::map::validation
