#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

namespace roadbed::map::validation {

enum class Severity { info, warning, error };
std::string_view name(Severity severity);

/// One fault of a map: what, where, and what to do.
struct Finding {
  std::string rule;       ///< "geometry.gap"
  std::string asam_rule;  ///< "asam.net:xodr:1.7.0:…", empty where there is none
  Severity severity = Severity::warning;
  std::string element;  ///< "road 12", "lane 12/0/-1"
  long line = 0;        ///< in the source file, 0 if unknown
  std::optional<Eigen::Vector2d> in_map;
  std::string message;  ///< with what to do
};

}  // namespace roadbed::map::validation
