#include "roadbed/map/validate_file.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/validation/rules.h"
#include "roadbed/map/validation/validate.h"

namespace roadbed::map {
namespace {

using Findings = std::vector<validation::Finding>;

void append(Findings& to, Findings from) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
}

void sort_by_rule(Findings& findings) {
  std::stable_sort(
      findings.begin(), findings.end(),
      [](const validation::Finding& a, const validation::Finding& b) { return a.rule < b.rule; });
}

/// "12" of "road 12" and of "lane 12/0/-1".
std::string road_of(const std::string& element) {
  const std::size_t from = element.find(' ') + 1;
  return element.substr(from, element.find('/', from) - from);
}

bool is_about_links(const validation::Finding& finding) {
  return finding.rule.starts_with("link.") || finding.rule.starts_with("id.dangling") ||
         finding.rule.starts_with("junction.");
}

/// What the text shows already, its reader and the map need not say again: remarks about a line
/// that has a finding, or about links of a road whose links have one, and findings of the same
/// ASAM rule about the same element.
void drop_repeats(Findings& of_map, const Findings& of_source) {
  std::set<long> lines;
  std::set<std::pair<std::string, std::string>> said;
  std::set<std::string> badly_linked;
  for (const validation::Finding& finding : of_source) {
    lines.insert(finding.line);
    if (is_about_links(finding)) badly_linked.insert(road_of(finding.element));
    if (!finding.asam_rule.empty()) said.emplace(finding.asam_rule, finding.element);
  }
  std::erase_if(of_map, [&](const validation::Finding& finding) {
    const bool remark =
        finding.rule.starts_with("import.") && finding.severity != validation::Severity::info;
    const bool said_of_links =
        finding.rule == "import.link" && badly_linked.contains(road_of(finding.element));
    return (remark && finding.line > 0 && lines.contains(finding.line)) || said_of_links ||
           said.contains({finding.asam_rule, finding.element});
  });
}

void add_lines(Findings& findings, const validation::ElementLines& lines) {
  for (validation::Finding& finding : findings) {
    if (finding.line > 0) continue;
    const auto found = lines.find(finding.element);
    if (found != lines.end()) finding.line = found->second;
  }
}

JudgedFile judge(MapBytes map, const std::string& name,
                 const validation::ValidateOptions& options) {
  if (map.format.judge != nullptr) return map.format.judge(std::move(map.bytes), name, options);
  JudgedFile judged;
  judged.road_map = map.format.read(std::move(map.bytes), name, {});
  return judged;
}

}  // namespace

std::vector<validation::RuleInfo> rule_catalogue() {
  std::vector<validation::RuleInfo> catalogue{well_formed_rule()};
  for (const Format& format : formats()) {
    if (format.rules == nullptr) continue;
    for (const validation::RuleInfo& rule : format.rules()) catalogue.push_back(rule);
  }
  for (const validation::MapRule& rule : validation::map_rules()) catalogue.push_back(rule.info);
  for (const validation::RuleInfo& rule : validation::import_rules()) catalogue.push_back(rule);
  std::sort(
      catalogue.begin(), catalogue.end(),
      [](const validation::RuleInfo& a, const validation::RuleInfo& b) { return a.id < b.id; });
  return catalogue;
}

Validation validate_bytes(std::string bytes, const std::string& name,
                          const validation::ValidateOptions& options) {
  JudgedFile judged = judge(map_bytes(std::move(bytes), name), name, options);
  Validation validation{std::move(judged.road_map), std::move(judged.refusal),
                        std::move(judged.findings)};
  if (validation.road_map) {
    for (validation::Finding& finding : validation.findings) {
      if (finding.in_map) finding.in_map = validation.road_map->to_map(*finding.in_map);
    }
    Findings of_map = validation::validate(*validation.road_map, options);
    drop_repeats(of_map, validation.findings);
    add_lines(of_map, judged.lines);
    append(validation.findings, std::move(of_map));
  }
  sort_by_rule(validation.findings);
  return validation;
}

Validation validate_file(const std::filesystem::path& file,
                         const validation::ValidateOptions& options) {
  return validate_bytes(read_file(file), file.string(), options);
}

}  // namespace roadbed::map
