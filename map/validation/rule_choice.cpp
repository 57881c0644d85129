#include "roadbed/map/validation/rule_choice.h"

#include <fmt/format.h>

#include <algorithm>

namespace roadbed::map::validation {
namespace {

/// "Lane.BorderSharing" of "Lane.BorderSharing-001".
std::string_view without_number(std::string_view issue) {
  return issue.substr(0, std::min(issue.rfind('-'), issue.size()));
}

/// Whether the rule of a reader: its names are not in the table of rules.
bool is_about_reading(std::string_view rule) {
  return rule.starts_with("import.") || rule.starts_with("source.");
}

bool is_in(Profile profile, std::string_view rule, bool has_asam_rule) {
  if (is_about_reading(rule)) return true;
  const bool is_autoware = rule.starts_with("autoware.");
  switch (profile) {
    case Profile::planning:
      return !is_autoware;
    case Profile::asam:
      return has_asam_rule;
    case Profile::autoware:
      return is_autoware || rule.starts_with("lanelet2.");
    case Profile::commonroad:
      return rule.starts_with("common-road.");
  }
  return true;
}

/// ASAM's names may begin with their version, as they stand in the table of rules.
bool fits_asam(std::string_view pattern, std::string_view name) {
  if (name.empty()) return false;
  return fits_pattern(pattern, name) || fits_pattern(pattern, without_asam_prefix(name));
}

template <typename Named>
bool fits_any(const std::vector<std::string>& patterns, const Named& named) {
  return std::ranges::any_of(patterns,
                             [&](const std::string& pattern) { return fits(pattern, named); });
}

bool is_chosen(const RuleChoice& choice, std::string_view rule, bool has_asam_rule) {
  if (!choice.profile && !choice.only.empty()) return true;
  return is_in(choice.profile.value_or(Profile::planning), rule, has_asam_rule);
}

}  // namespace

bool fits_pattern(std::string_view pattern, std::string_view text) {
  // Where a star met more text than it had to, and how much of it: it takes one letter more each
  // time the rest does not fit.
  std::size_t star = std::string_view::npos, taken = 0, at = 0, next = 0;
  while (at < text.size()) {
    if (next < pattern.size() && pattern[next] == '*') {
      star = next++;
      taken = at;
    } else if (next < pattern.size() && (pattern[next] == '?' || pattern[next] == text[at])) {
      ++next, ++at;
    } else if (star != std::string_view::npos) {
      next = star + 1;
      at = ++taken;
    } else {
      return false;
    }
  }
  return pattern.substr(next).find_first_not_of('*') == std::string_view::npos;
}

std::string_view without_asam_prefix(std::string_view name) {
  constexpr std::string_view prefix = "asam.net:xodr:";
  return name.starts_with(prefix) ? name.substr(prefix.size()) : name;
}

bool fits(std::string_view pattern, const Finding& finding) {
  if (fits_pattern(pattern, finding.rule)) return true;
  if (fits_asam(pattern, finding.asam_rule)) return true;
  return !finding.autoware_issue.empty() &&
         (fits_pattern(pattern, finding.autoware_issue) ||
          fits_pattern(pattern, without_number(finding.autoware_issue)));
}

bool fits(std::string_view pattern, const RuleInfo& rule) {
  // The readers' remarks stand in the table as "import.…".
  if (rule.id == "import.…" && pattern.starts_with("import.")) return true;
  if (fits_pattern(pattern, rule.id)) return true;
  if (fits_asam(pattern, rule.asam_rule)) return true;
  if (rule.autoware_rule.empty()) return false;
  if (fits_pattern(pattern, rule.autoware_rule)) return true;
  constexpr int kMostIssues = 20;  // of one rule
  for (int number = 1; number <= kMostIssues; ++number) {
    if (fits_pattern(pattern, fmt::format("{}-{:03}", rule.autoware_rule, number))) return true;
  }
  return false;
}

bool RuleChoice::asks_for(const RuleInfo& rule) const {
  return is_chosen(*this, rule.id, !rule.asam_rule.empty()) &&
         (only.empty() || fits_any(only, rule)) &&
         std::ranges::none_of(disabled, [&](const std::string& pattern) {
           return fits_pattern(pattern, rule.id);  // an issue's name leaves the others
         });
}

bool RuleChoice::names(std::string_view autoware_issue) const {
  return std::ranges::count(only, autoware_issue) > 0 ||
         std::ranges::any_of(severities,
                             [&](const auto& named) { return named.first == autoware_issue; });
}

void RuleChoice::apply(std::vector<Finding>& findings) const {
  std::erase_if(findings, [&](Finding& finding) {
    if (!is_chosen(*this, finding.rule, !finding.asam_rule.empty()) ||
        (!only.empty() && !fits_any(only, finding)) || fits_any(disabled, finding)) {
      return true;
    }
    const auto last = std::find_if(severities.rbegin(), severities.rend(),
                                   [&](const auto& named) { return fits(named.first, finding); });
    if (last == severities.rend()) return false;
    if (last->second) finding.severity = *last->second;
    return !last->second;
  });
}

}  // namespace roadbed::map::validation
