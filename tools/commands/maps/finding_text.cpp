#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "roadbed/tools/commands/maps/finding_reports.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

using map::validation::Finding;
using map::validation::Severity;

constexpr std::size_t kShown = 5;  // findings of one rule

/// Findings of one rule that the baseline does not have.
using Group = std::vector<const Finding*>;

/// In order of rule, as the findings are.
std::vector<Group> groups_of(const FindingReport& report) {
  std::vector<Group> groups;
  const std::vector<Finding>& findings = report.validation.findings;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    if (report.is_known(i)) continue;
    if (groups.empty() || groups.back().front()->rule != findings[i].rule) groups.emplace_back();
    groups.back().push_back(&findings[i]);
  }
  return groups;
}

template <typename Findings>
std::array<std::size_t, 3> counts_of(const Findings& findings) {
  std::array<std::size_t, 3> counts{};
  for (const Finding* finding : findings) ++counts[static_cast<std::size_t>(finding->severity)];
  return counts;
}

std::string counted(std::size_t count, std::string_view one) {
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

/// "2 errors, 1 note": what there is, the gravest first.
std::string counts_text(const std::array<std::size_t, 3>& counts) {
  constexpr std::array<std::string_view, 3> kNames = {"note", "warning", "error"};
  std::string text;
  for (std::size_t i = counts.size(); i-- > 0;) {
    if (counts[i] == 0) continue;
    text += (text.empty() ? "" : ", ") + counted(counts[i], kNames[i]);
  }
  return text;
}

/// "geometry.gap: 2 warnings: lane 1/0/-1 (line 12), lane 2/0/1 (line 39)".
std::string summary_line(const Group& group) {
  constexpr std::size_t kNamed = 3;
  std::string text = fmt::format("{}: {}: ", group.front()->rule, counts_text(counts_of(group)));
  for (std::size_t i = 0; i < std::min(group.size(), kNamed); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", group[i]->element);
    if (group[i]->line > 0) text += fmt::format(" (line {})", group[i]->line);
  }
  if (group.size() > kNamed) text += fmt::format(" and {} more", group.size() - kNamed);
  return text + "\n";
}

std::string place_text(const FindingReport& report, const Finding& finding) {
  std::string text = finding.line > 0 ? fmt::format(":{}", finding.line) : "";
  if (finding.in_map) {
    const Eigen::Vector2d in_source = report.validation.to_source(*finding.in_map);
    text += fmt::format(" ({:.2f}, {:.2f})", in_source.x(), in_source.y());
  }
  return text;
}

std::string detail_lines(const FindingReport& report, const std::string& file, const Group& group) {
  const std::size_t shown = report.is_complete ? group.size() : std::min(group.size(), kShown);
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) {
    const Finding& finding = *group[i];
    const std::string issue =
        finding.autoware_issue.empty() ? std::string() : " " + finding.autoware_issue;
    text += fmt::format("{}{}: {}: {}: {} [{}{}]\n", file, place_text(report, finding),
                        to_string(finding.severity), finding.element, finding.message, finding.rule,
                        issue);
  }
  if (shown < group.size()) {
    text += fmt::format("{}: and {} more of {}; --all prints them\n", file, group.size() - shown,
                        group.front()->rule);
  }
  return text;
}

std::string gone_lines(const FindingReport& report) {
  std::string text;
  if (!report.baseline) return text;
  for (const Finding& gone : report.baseline->gone) {
    text += fmt::format("gone: {} [{}{}{}]\n", gone.element, gone.rule,
                        gone.autoware_issue.empty() ? "" : " ", gone.autoware_issue);
  }
  return text;
}

std::string last_line(const FindingReport& report, const std::vector<Group>& groups) {
  std::array<std::size_t, 3> counts{};
  std::size_t told = 0;
  for (const Group& group : groups) {
    const auto more = counts_of(group);
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += more[i];
    told += group.size();
  }
  std::string text =
      fmt::format("{} errors, {} warnings, {} notes", counts[2], counts[1], counts[0]);
  if (report.baseline) {
    text += fmt::format(" that are new, {} known, {} gone",
                        report.validation.findings.size() - told, report.baseline->gone.size());
    if (const std::size_t unasked = report.baseline->unasked; unasked > 0) {
      text += fmt::format(", {} not looked for", unasked);
    }
  }
  if (!report.validation.suppressed.empty()) {
    text += fmt::format(", {} suppressed by the map", report.validation.suppressed.size());
  }
  return text + "\n";
}

}  // namespace

std::string findings_text(const FindingReport& report, const std::string& file) {
  const std::vector<Group> groups = groups_of(report);
  std::string text;
  for (const Group& group : groups) text += summary_line(group);
  if (!groups.empty()) text += "\n";
  for (const Group& group : groups) text += detail_lines(report, file, group);
  return text + gone_lines(report) + last_line(report, groups);
}

}  // namespace roadbed::tools::commands::maps
