#include "roadbed/map/validation/validate.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "roadbed/map/formats/xml.h"
#include "roadbed/map/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/read_file.h"
#include "roadbed/map/validation/rules.h"
#include "roadbed/map/validation/source.h"

namespace roadbed::map {
namespace {

using Findings = std::vector<Finding>;

void append(Findings& to, Findings from) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
}

void sort_by_rule(Findings& findings) {
  std::stable_sort(findings.begin(), findings.end(),
                   [](const Finding& a, const Finding& b) { return a.rule < b.rule; });
}

/// "12" of "road 12" and of "lane 12/0/-1".
std::string road_of(const std::string& element) {
  const std::size_t from = element.find(' ') + 1;
  return element.substr(from, element.find('/', from) - from);
}

bool is_about_links(const Finding& finding) {
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
  for (const Finding& finding : of_source) {
    lines.insert(finding.line);
    if (is_about_links(finding)) badly_linked.insert(road_of(finding.element));
    if (!finding.asam_rule.empty()) said.emplace(finding.asam_rule, finding.element);
  }
  std::erase_if(of_map, [&](const Finding& finding) {
    const bool remark = finding.rule.starts_with("import.") && finding.severity != Severity::info;
    const bool said_of_links =
        finding.rule == "import.link" && badly_linked.contains(road_of(finding.element));
    return (remark && finding.line > 0 && lines.contains(finding.line)) || said_of_links ||
           said.contains({finding.asam_rule, finding.element});
  });
}

void add_lines(Findings& findings, const rules::ElementLines& lines) {
  for (Finding& finding : findings) {
    if (finding.line > 0) continue;
    const auto found = lines.find(finding.element);
    if (found != lines.end()) finding.line = found->second;
  }
}

bool looks_like_xml(const std::string& bytes) {
  const auto first = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return first != std::string::npos && bytes[first] == '<';
}

Finding refused(const std::string& message) {
  return {.rule = "import.refused",
          .asam_rule = {},
          .severity = Severity::error,
          .element = "file",
          .line = 0,
          .in_map = std::nullopt,
          .message = message};
}

/// What the text of the file shows, and the lines of its elements.
struct TextFindings {
  Findings findings;
  rules::ElementLines lines;
  bool is_well_formed = false;
};

TextFindings check_text(const std::string& bytes, const std::string& name,
                        const ValidateOptions& options) {
  if (!looks_like_xml(bytes)) return {};
  try {
    const XmlDocument xml(bytes, name);
    return {rules::check_source(xml, options), rules::element_lines(xml), true};
  } catch (const InputError& error) {
    if (!rules::names_known_format(bytes)) throw;
    return {{rules::not_well_formed(name, error.what())}, {}, false};
  }
}

}  // namespace

std::string_view name(Severity severity) {
  switch (severity) {
    case Severity::info:
      return "info";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "error";
}

std::vector<Finding> validate(const RoadMap& road_map, const ValidateOptions& options) {
  Findings findings;
  for (const rules::MapRule& rule : rules::map_rules()) {
    rules::Report report(rule.info, findings);
    rule.check(road_map, options, report);
    report.finish();
  }
  append(findings, rules::import_remarks(road_map));
  sort_by_rule(findings);
  return findings;
}

Validation validate_bytes(std::string bytes, const std::string& name,
                          const ValidateOptions& options) {
  TextFindings text = check_text(bytes, name, options);
  const bool names_format = rules::names_known_format(bytes);
  Validation validation;
  validation.findings = std::move(text.findings);
  try {
    validation.road_map = parse_map(std::move(bytes), name);
  } catch (const InputError& error) {
    if (!names_format) throw;
    validation.refusal = error.what();
    if (text.is_well_formed) validation.findings.push_back(refused(error.what()));
  }
  if (validation.road_map) {
    for (Finding& finding : validation.findings) {
      if (finding.in_map) finding.in_map = validation.road_map->to_map(*finding.in_map);
    }
    Findings of_map = validate(*validation.road_map, options);
    drop_repeats(of_map, validation.findings);
    add_lines(of_map, text.lines);
    append(validation.findings, std::move(of_map));
  }
  sort_by_rule(validation.findings);
  return validation;
}

Validation validate_file(const std::filesystem::path& file, const ValidateOptions& options) {
  return validate_bytes(read_file(file), file.string(), options);
}

}  // namespace roadbed::map
