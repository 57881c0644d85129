#include "roadbed/tools/commands/maps/finding_baseline.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>

#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

using map::validation::Finding;
using map::validation::Severity;

std::string text_if_any(const JsonNode& finding, const char* name) {
  const auto found = finding.find(name);
  return found && !found->value().is_null() ? found->text() : std::string();
}

Severity severity_in(const JsonNode& finding) {
  const std::string text = text_if_any(finding, "severity");
  for (const Severity severity : {Severity::info, Severity::warning}) {
    if (text == to_string(severity)) return severity;
  }
  return Severity::error;
}

/// Of findings of one rule, issue and element, by severity.
using Known = std::array<std::vector<Finding>, 3>;

/// Takes the mildest that is as grave as the finding.
bool take(Known& known, Severity severity) {
  for (auto i = static_cast<std::size_t>(severity); i < known.size(); ++i) {
    if (known[i].empty()) continue;
    known[i].pop_back();
    return true;
  }
  return false;
}

std::tuple<std::string, std::string, std::string> key_of(const Finding& finding) {
  return {finding.rule, finding.autoware_issue, finding.element};
}

}  // namespace

std::vector<Finding> read_baseline(const std::filesystem::path& file) {
  const std::string name = map::input_name(file);
  const nlohmann::json document = parse_json_strictly(map::read_file(file), name);
  const JsonNode root(document, name);
  root.check_version("findings");
  std::vector<Finding> baseline;
  for (const JsonNode& finding : root.at("findings").elements()) {
    baseline.push_back({.rule = finding.at("rule").text(),
                        .asam_rule = text_if_any(finding, "asam_rule"),
                        .severity = severity_in(finding),
                        .element = finding.at("element").text(),
                        .in_map = std::nullopt,
                        .message = {},
                        .autoware_issue = text_if_any(finding, "autoware_issue")});
  }
  return baseline;
}

BaselineDiff compare_with_baseline(const std::vector<Finding>& findings,
                                   std::vector<Finding> baseline,
                                   const map::validation::RuleChoice& choice) {
  BaselineDiff diff;
  diff.unasked = baseline.size();
  choice.apply(baseline);
  diff.unasked -= baseline.size();
  std::map<std::tuple<std::string, std::string, std::string>, Known> left;
  for (Finding& known : baseline) {
    Known& of_key = left[key_of(known)];
    of_key[static_cast<std::size_t>(known.severity)].push_back(std::move(known));
  }
  for (const Finding& finding : findings) {
    const auto found = left.find(key_of(finding));
    diff.known.push_back(found != left.end() && take(found->second, finding.severity));
  }
  for (auto& [key, known] : left) {
    for (auto& of_severity : known) std::ranges::move(of_severity, std::back_inserter(diff.gone));
  }
  return diff;
}

}  // namespace roadbed::tools::commands::maps
