#include "roadbed/tools/commands/finding_reports.h"
#include "roadbed/tools/files/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "roadbed/map/drawing/write_svg.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/validation/rule.h"

namespace roadbed::tools::inline commands {
namespace {

using map::Validation;
using map::validation::Finding;

std::string document_text(const Json& json) { return map::json_text(json, 2) + "\n"; }

Json finding_json(const Validation& validation, const Finding& finding) {
  Json json = {{"rule", finding.rule}};
  json["asam_rule"] = finding.asam_rule.empty() ? Json() : Json(finding.asam_rule);
  json["severity"] = to_string(finding.severity);
  json["element"] = finding.element;
  json["line"] = finding.line > 0 ? Json(finding.line) : Json();
  const Eigen::Vector2d in_source =
      finding.in_map ? validation.to_source(*finding.in_map) : Eigen::Vector2d(0, 0);
  json["x_m"] = finding.in_map ? Json(in_source.x()) : Json();
  json["y_m"] = finding.in_map ? Json(in_source.y()) : Json();
  json["message"] = finding.message;
  return json;
}

std::string place_text(const Validation& validation, const Finding& finding) {
  std::string text = finding.line > 0 ? fmt::format(":{}", finding.line) : "";
  if (finding.in_map) {
    const Eigen::Vector2d in_source = validation.to_source(*finding.in_map);
    text += fmt::format(" ({:.2f}, {:.2f})", in_source.x(), in_source.y());
  }
  return text;
}

long findings_counted(const Validation& validation, map::validation::Severity severity) {
  return std::count_if(validation.findings.begin(), validation.findings.end(),
                       [&](const Finding& finding) { return finding.severity == severity; });
}

std::string line_of(const Validation& validation, const Finding& finding) {
  return fmt::format("{}{}: {}: {}", finding.element, place_text(validation, finding),
                     to_string(finding.severity), finding.message);
}

/// Findings by rule, in order of rule.
std::map<std::string, std::vector<const Finding*>> by_rule(const Validation& validation) {
  std::map<std::string, std::vector<const Finding*>> groups;
  for (const map::validation::RuleInfo& rule : map::rule_catalogue()) groups[std::string(rule.id)];
  for (const Finding& finding : validation.findings) groups[finding.rule].push_back(&finding);
  return groups;
}

bool is_fault(const Finding* finding) {
  return finding->severity != map::validation::Severity::info;
}

std::string test_case(const Validation& validation, const std::string& file,
                      const std::string& rule, const std::vector<const Finding*>& findings) {
  std::string faults, notes;
  for (const Finding* finding : findings) {
    (is_fault(finding) ? faults : notes) += line_of(validation, *finding) + "\n";
  }
  std::string text = fmt::format(R"(    <testcase classname="{}" name="{}")", map::html_text(file),
                                 map::html_text(rule));
  if (findings.empty()) return text + "/>\n";
  text += ">\n";
  if (!faults.empty()) {
    const auto number = std::count_if(findings.begin(), findings.end(), is_fault);
    text += fmt::format("      <failure message=\"{} found\">{}</failure>\n", number,
                        map::html_text(faults));
  }
  if (!notes.empty()) {
    text += fmt::format("      <system-out>{}</system-out>\n", map::html_text(notes));
  }
  return text + "    </testcase>\n";
}

const char* sarif_level(map::validation::Severity severity) {
  switch (severity) {
    case map::validation::Severity::info:
      return "note";
    case map::validation::Severity::warning:
      return "warning";
    case map::validation::Severity::error:
      return "error";
  }
  return "error";
}

Json sarif_rule(const map::validation::RuleInfo& rule) {
  Json json = {{"id", rule.id},
               {"shortDescription", {{"text", rule.meaning}}},
               {"defaultConfiguration", {{"level", sarif_level(rule.severity)}}}};
  if (!rule.asam_rule.empty()) json["properties"] = {{"asam_rule", rule.asam_rule}};
  return json;
}

/// A path as the reference of a URI: what may not stand in one is written as %XX.
std::string uri_of(const std::string& file) {
  static constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
  std::string uri;
  for (const char letter : file) {
    if (kPlain.find(letter) != std::string_view::npos) {
      uri += letter;
    } else {
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(letter));
    }
  }
  return uri;
}

Json sarif_result(const Validation& validation, const Finding& finding, const std::string& file,
                  const std::map<std::string, std::size_t>& index) {
  Json physical = {{"artifactLocation", {{"uri", uri_of(file)}}}};
  if (finding.line > 0) physical["region"] = {{"startLine", finding.line}};
  Json result = {{"ruleId", finding.rule}};
  const auto rule = index.find(finding.rule);
  if (rule != index.end()) result["ruleIndex"] = rule->second;
  result["level"] = sarif_level(finding.severity);
  result["message"] = {{"text", finding.element + ": " + finding.message}};
  result["locations"] = Json::array(
      {{{"physicalLocation", physical},
        {"logicalLocations", Json::array({{{"name", finding.element}, {"kind", "element"}}})}}});
  if (finding.in_map) {
    const Eigen::Vector2d in_source = validation.to_source(*finding.in_map);
    result["properties"] = {{"x_m", in_source.x()}, {"y_m", in_source.y()}};
  }
  return result;
}

const char* colour(map::validation::Severity severity) {
  switch (severity) {
    case map::validation::Severity::info:
      return "#2f6fb3";
    case map::validation::Severity::warning:
      return "#d98a00";
    case map::validation::Severity::error:
      return "#c8102e";
  }
  return "#c8102e";
}

}  // namespace

std::string findings_text(const Validation& validation, const std::string& file) {
  std::string text;
  for (const Finding& finding : validation.findings) {
    text +=
        fmt::format("{}{}: {}: {}: {} [{}]\n", file, place_text(validation, finding),
                    to_string(finding.severity), finding.element, finding.message, finding.rule);
  }
  return text + fmt::format("{} errors, {} warnings, {} notes\n",
                            findings_counted(validation, map::validation::Severity::error),
                            findings_counted(validation, map::validation::Severity::warning),
                            findings_counted(validation, map::validation::Severity::info));
}

std::string findings_json(const Validation& validation) {
  Json list = Json::array();
  for (const Finding& finding : validation.findings) {
    list.push_back(finding_json(validation, finding));
  }
  return document_text(versioned("findings", {{"findings", std::move(list)}}));
}

std::string findings_junit(const Validation& validation, const std::string& file) {
  const auto groups = by_rule(validation);
  const auto failures = std::count_if(groups.begin(), groups.end(), [](const auto& group) {
    return std::any_of(group.second.begin(), group.second.end(), is_fault);
  });
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"roadbed validate {}\" tests=\"{}\" failures=\"{}\" errors=\"0\">\n",
      map::html_text(file), groups.size(), failures);
  for (const auto& [rule, findings] : groups) text += test_case(validation, file, rule, findings);
  return text + "  </testsuite>\n</testsuites>\n";
}

std::string findings_sarif(const Validation& validation, const std::string& file) {
  Json rules = Json::array();
  std::map<std::string, std::size_t> index;
  for (const map::validation::RuleInfo& rule : map::rule_catalogue()) {
    index.emplace(rule.id, rules.size());
    rules.push_back(sarif_rule(rule));
  }
  Json results = Json::array();
  for (const Finding& finding : validation.findings) {
    results.push_back(sarif_result(validation, finding, file, index));
  }
  Json run = {{"tool", {{"driver", {{"name", "roadbed"}, {"rules", std::move(rules)}}}}},
              {"columnKind", "utf16CodeUnits"},
              {"results", std::move(results)}};
  return document_text({{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
                        {"version", "2.1.0"},
                        {"runs", Json::array({std::move(run)})}});
}

std::string findings_geojson(const Validation& validation) {
  Json features = Json::array();
  for (const Finding& finding : validation.findings) {
    if (!finding.in_map) continue;
    const Eigen::Vector2d in_source = validation.to_source(*finding.in_map);
    features.push_back(
        {{"type", "Feature"},
         {"geometry",
          {{"type", "Point"}, {"coordinates", Json::array({in_source.x(), in_source.y()})}}},
         {"properties", finding_json(validation, finding)}});
  }
  Json json = {{"type", "FeatureCollection"}};
  if (validation.road_map && !validation.road_map->crs().empty()) {
    json["crs"] = {{"type", "name"}, {"properties", {{"name", validation.road_map->crs()}}}};
  }
  json["features"] = std::move(features);
  return document_text(json);
}

std::string findings_svg(const Validation& validation) {
  if (!validation.road_map) throw std::invalid_argument("findings_svg: there is no map");
  map::SvgOptions options;
  for (const Finding& finding : validation.findings) {
    if (!finding.in_map) continue;
    options.marks.push_back(
        {*finding.in_map, colour(finding.severity),
         fmt::format("{}: {} [{}]", finding.element, finding.message, finding.rule)});
  }
  return map::write_svg(*validation.road_map, options);
}

std::string rules_table() {
  std::string table = "| rule | severity | ASAM rule | finds |\n|---|---|---|---|\n";
  for (const map::validation::RuleInfo& rule : map::rule_catalogue()) {
    const std::string asam =
        rule.asam_rule.empty() ? "" : fmt::format("`{}`", rule.asam_rule.substr(14));
    table += fmt::format("| `{}` | {} | {} | {} |\n", rule.id, to_string(rule.severity), asam,
                         rule.meaning);
  }
  return table;
}

}  // namespace roadbed::tools::commands
