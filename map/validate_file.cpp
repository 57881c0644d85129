#include "roadbed/map/validate_file.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/formats.h"
#include "roadbed/map/load_map.h"
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

/// A rule of ASAM's that a finding about the text names need not be named again for what the map
/// shows of the same element.
void drop_told(Findings& of_map, const Findings& of_text) {
  std::set<std::pair<std::string_view, std::string_view>> told;
  for (const validation::Finding& finding : of_text) {
    if (!finding.asam_rule.empty()) told.emplace(finding.asam_rule, finding.element);
  }
  std::erase_if(of_map, [&](const validation::Finding& finding) {
    return told.contains({finding.asam_rule, finding.element});
  });
}

void add_lines(Findings& findings, const validation::ElementLines& lines) {
  for (validation::Finding& finding : findings) {
    if (finding.line > 0) continue;
    const auto found = lines.find(finding.element);
    if (found != lines.end()) finding.line = found->second;
  }
}

JudgedFile judge(std::string bytes, const std::string& name,
                 const validation::ValidateOptions& options) {
  if (looks_like_xml(bytes) && format_of(bytes) == nullptr) {
    if (auto judged = judge_unknown_root(bytes, name)) return *std::move(judged);
  }
  MapBytes map = map_bytes(std::move(bytes), name);
  if (map.format.judge != nullptr) return map.format.judge(std::move(map.bytes), name, options);
  JudgedFile judged;
  judged.road_map = map.format.read(std::move(map.bytes), name, {});
  return judged;
}

}  // namespace

std::vector<validation::RuleInfo> rule_catalogue() {
  std::vector<validation::RuleInfo> catalogue = file_rules();
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
  JudgedFile judged = judge(std::move(bytes), name, options);
  Validation validation{std::move(judged.road_map), std::move(judged.refusal),
                        std::move(judged.findings), std::move(judged.lines)};
  if (validation.road_map) {
    for (validation::Finding& finding : validation.findings) {
      if (finding.in_map) finding.in_map = validation.road_map->to_map(*finding.in_map);
    }
    Findings of_map = validation::validate(*validation.road_map, options);
    drop_told(of_map, validation.findings);
    add_lines(of_map, validation.lines);
    append(validation.findings, std::move(of_map));
  }
  sort_by_rule(validation.findings);
  return validation;
}

Validation validate_file(const std::filesystem::path& file,
                         const validation::ValidateOptions& options) {
  return validate_bytes(read_file(file), input_name(file), options);
}

}  // namespace roadbed::map
