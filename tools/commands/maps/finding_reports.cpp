#include "roadbed/tools/commands/maps/finding_reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "roadbed/map/drawing/write_svg.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/validation/rule.h"
#include "roadbed/map/validation/rule_choice.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

using map::Validation;
using map::validation::Finding;

std::string document_text(const Json& json) { return map::json_text(json, 2) + "\n"; }

Json finding_json(const Validation& validation, const Finding& finding) {
  Json json = {{"rule", finding.rule}};
  json["asam_rule"] = finding.asam_rule.empty() ? Json() : Json(finding.asam_rule);
  json["autoware_issue"] = finding.autoware_issue.empty() ? Json() : Json(finding.autoware_issue);
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

std::string line_of(const Validation& validation, const Finding& finding) {
  return fmt::format("{}{}: {}: {}", finding.element, place_text(validation, finding),
                     to_string(finding.severity), finding.message);
}

/// A finding, and whether the baseline has it.
struct Told {
  const Finding* finding;
  bool is_known;
};

/// Findings by rule, in order of rule.
std::map<std::string, std::vector<Told>> by_rule(const FindingReport& report) {
  std::map<std::string, std::vector<Told>> groups;
  for (const map::validation::RuleInfo& rule : map::rule_catalogue()) {
    if (report.choice.asks_for(rule)) groups[std::string(rule.id)];
  }
  const std::vector<Finding>& findings = report.validation.findings;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    groups[findings[i].rule].push_back({&findings[i], report.is_known(i)});
  }
  return groups;
}

bool is_fault(const Told& told) {
  return !told.is_known && told.finding->severity != map::validation::Severity::info;
}

/// With Autoware's name of the issue, where it has one.
std::string test_line(const Validation& validation, const Told& told) {
  const std::string issue = told.finding->autoware_issue.empty()
                                ? std::string()
                                : fmt::format(" [{}]", told.finding->autoware_issue);
  return fmt::format("{}{}{}\n", told.is_known ? "known: " : "", line_of(validation, *told.finding),
                     issue);
}

std::string test_case(const Validation& validation, const std::string& file,
                      const std::string& rule, const std::vector<Told>& findings) {
  std::string faults, notes;
  for (const Told& told : findings) {
    (is_fault(told) ? faults : notes) += test_line(validation, told);
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
  if (!rule.asam_rule.empty()) json["properties"]["asam_rule"] = rule.asam_rule;
  if (!rule.autoware_rule.empty()) json["properties"]["autoware_rule"] = rule.autoware_rule;
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
  if (!finding.autoware_issue.empty()) {
    result["properties"]["autoware_issue"] = finding.autoware_issue;
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

std::string findings_json(const FindingReport& report) {
  const Validation& validation = report.validation;
  Json list = Json::array(), suppressed = Json::array();
  for (std::size_t i = 0; i < validation.findings.size(); ++i) {
    list.push_back(finding_json(validation, validation.findings[i]));
    if (report.baseline) list.back()["known"] = report.is_known(i);
  }
  for (const Finding& finding : validation.suppressed) {
    suppressed.push_back(finding_json(validation, finding));
  }
  Json document = {{"findings", std::move(list)}, {"suppressed", std::move(suppressed)}};
  if (report.baseline) {
    document["gone"] = Json::array();
    for (const Finding& gone : report.baseline->gone) {
      document["gone"].push_back(
          {{"rule", gone.rule},
           {"autoware_issue", gone.autoware_issue.empty() ? Json() : Json(gone.autoware_issue)},
           {"element", gone.element}});
    }
  }
  return document_text(versioned("findings", document));
}

std::string findings_junit(const FindingReport& report, const std::string& file) {
  const auto groups = by_rule(report);
  const auto failures = std::count_if(groups.begin(), groups.end(), [](const auto& group) {
    return std::any_of(group.second.begin(), group.second.end(), is_fault);
  });
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"roadbed validate {}\" tests=\"{}\" failures=\"{}\" errors=\"0\">\n",
      map::html_text(file), groups.size(), failures);
  for (const auto& [rule, findings] : groups) {
    text += test_case(report.validation, file, rule, findings);
  }
  return text + "  </testsuite>\n</testsuites>\n";
}

std::string findings_sarif(const FindingReport& report, const std::string& file) {
  Json rules = Json::array();
  std::map<std::string, std::size_t> index;
  for (const map::validation::RuleInfo& rule : map::rule_catalogue()) {
    index.emplace(rule.id, rules.size());
    rules.push_back(sarif_rule(rule));
  }
  const Validation& validation = report.validation;
  Json results = Json::array();
  for (std::size_t i = 0; i < validation.findings.size(); ++i) {
    results.push_back(sarif_result(validation, validation.findings[i], file, index));
    if (!report.baseline) continue;
    results.back()["baselineState"] = report.is_known(i) ? "unchanged" : "new";
  }
  for (const Finding& finding : validation.suppressed) {
    results.push_back(sarif_result(validation, finding, file, index));
    results.back()["suppressions"] = Json::array({{{"kind", "inSource"}}});
  }
  Json run = {{"tool", {{"driver", {{"name", "roadbed"}, {"rules", std::move(rules)}}}}},
              {"columnKind", "utf16CodeUnits"},
              {"results", std::move(results)}};
  return document_text({{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
                        {"version", "2.1.0"},
                        {"runs", Json::array({std::move(run)})}});
}

std::string findings_geojson(const FindingReport& report) {
  const Validation& validation = report.validation;
  Json features = Json::array();
  for (std::size_t i = 0; i < validation.findings.size(); ++i) {
    const Finding& finding = validation.findings[i];
    if (!finding.in_map) continue;
    const Eigen::Vector2d in_source = validation.to_source(*finding.in_map);
    Json properties = finding_json(validation, finding);
    if (report.baseline) properties["known"] = report.is_known(i);
    features.push_back(
        {{"type", "Feature"},
         {"geometry",
          {{"type", "Point"}, {"coordinates", Json::array({in_source.x(), in_source.y()})}}},
         {"properties", std::move(properties)}});
  }
  Json json = {{"type", "FeatureCollection"}};
  if (validation.road_map && !validation.road_map->crs().empty()) {
    json["crs"] = {{"type", "name"}, {"properties", {{"name", validation.road_map->crs()}}}};
  }
  json["features"] = std::move(features);
  return document_text(json);
}

std::string findings_svg(const FindingReport& report) {
  const Validation& validation = report.validation;
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
  std::string table = "| rule | severity | ASAM or Autoware rule | finds |\n|---|---|---|---|\n";
  for (const map::validation::RuleInfo& rule : map::rule_catalogue()) {
    std::string other;
    if (!rule.asam_rule.empty()) {
      other = fmt::format("`{}`", map::validation::without_asam_prefix(rule.asam_rule));
    } else if (!rule.autoware_rule.empty()) {
      other = fmt::format("`{}`", rule.autoware_rule);
    }
    table += fmt::format("| `{}` | {} | {} | {} |\n", rule.id, to_string(rule.severity), other,
                         rule.meaning);
  }
  return table;
}

}  // namespace roadbed::tools::commands::maps
