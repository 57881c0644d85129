#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/validation/finding.h"

namespace roadbed::map::validation {

/// What a map is judged for.
enum class Profile {
  planning,    ///< every rule but Autoware's
  asam,        ///< rules that ASAM has, too
  autoware,    ///< Autoware's, and those about the text of Lanelet2 files
  commonroad,  ///< those about the text of CommonRoad files
};

/// Which rules look at a map, and how grave their findings are. What keeps a file from being read,
/// or what its reader mended, is in every profile.
///
/// Patterns are ids ("geometry.gap"), ASAM's names ("1.0.0:xml.valid_schema"), Autoware's of rules
/// ("Lane.BorderSharing") or issues ("Lane.BorderSharing-002"); `*`: any text, `?`: any letter.
struct RuleChoice {
  std::optional<Profile> profile;     ///< none: planning, or all rules where some are named
  std::vector<std::string> only;      ///< no others than these; empty: all
  std::vector<std::string> disabled;  ///< not these

  /// Of findings: the last pattern that fits counts; none: they are left out.
  std::vector<std::pair<std::string, std::optional<Severity>>> severities;

  /// Whether a rule may find something that is asked for.
  bool asks_for(const RuleInfo& rule) const;

  /// Whether `only` or `severities` name an issue itself, so that one which nobody requires any
  /// more is looked for.
  bool names(std::string_view autoware_issue) const;

  /// Leaves out findings that are not asked for, and gives the others their severity.
  void apply(std::vector<Finding>& findings) const;
};

/// Whether a pattern fits a finding's rule, under any of its names.
bool fits(std::string_view pattern, const Finding& finding);

/// Whether a pattern fits a rule, under any of its names, or an issue that it may find.
bool fits(std::string_view pattern, const RuleInfo& rule);

/// "1.0.0:xml.valid_schema" of "asam.net:xodr:1.0.0:xml.valid_schema".
std::string_view without_asam_prefix(std::string_view name);

/// Whether a text is what a pattern with `*` and `?` describes. O(pattern · text).
bool fits_pattern(std::string_view pattern, std::string_view text);

}  // namespace roadbed::map::validation
