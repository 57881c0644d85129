#include "roadbed/map/judged_file.h"

#include <fmt/format.h>

#include <charconv>
#include <iterator>
#include <utility>

#include "roadbed/map/commonroad/read.h"
#include "roadbed/map/commonroad/rules/rules.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/lanelet2/autoware/rules.h"
#include "roadbed/map/lanelet2/read.h"
#include "roadbed/map/lanelet2/rules/source.h"
#include "roadbed/map/opendrive/read.h"
#include "roadbed/map/opendrive/rules/source.h"
#include "roadbed/map/suppressions.h"

namespace roadbed::map {
namespace {

constexpr validation::RuleInfo kNotWellFormed = {
    "source.not-well-formed", "asam.net:xodr:1.0.0:xml.valid_xml_document",
    validation::Severity::error, "the file is no well-formed XML"};

constexpr validation::RuleInfo kUnknownRoot = {
    "source.root-element", "asam.net:xodr:1.0.0:xml.root_tag_is_opendrive",
    validation::Severity::error, "the root element of an OpenDRIVE file has another name"};

/// Line in a message of the form "FILE:LINE: …", 0 if there is none.
long line_in(const std::string& message, const std::string& name) {
  if (!message.starts_with(name + ":")) return 0;
  long line = 0;
  std::from_chars(message.data() + name.size() + 1, message.data() + message.size(), line);
  return line;
}

validation::Finding not_well_formed(const std::string& message, const std::string& name) {
  std::vector<validation::Finding> findings;
  validation::Report report(kNotWellFormed, findings);
  report.add("file", std::nullopt, message).line = line_in(message, name);
  return findings.front();
}

validation::Finding refused(const std::string& message) {
  return {.rule = "import.refused",
          .asam_rule = {},
          .severity = validation::Severity::error,
          .element = "file",
          .line = 0,
          .in_map = std::nullopt,
          .message = message};
}

/// What `read` makes of the file; none if that refuses it, which then is a finding.
template <typename Read, typename Say>
auto made(JudgedFile& judged, const Say& finding, const Read& read)
    -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const InputError& error) {
    judged.refusal = error.what();
    judged.findings.push_back(finding(error.what()));
    return {};
  }
}

/// A step of reading a file: none if its text is not well-formed.
template <typename Read>
auto parsed(JudgedFile& judged, const std::string& name, const Read& read) {
  return made(
      judged, [&](const char* message) { return not_well_formed(message, name); }, read);
}

/// The map, without the remarks that rules about the text make, too.
template <typename Read>
void read_into(JudgedFile& judged, const Read& read) {
  judged.road_map = made(judged, refused, [&] {
    RoadMapParts parts = read();
    std::erase_if(parts.remarks, &ImportDiagnostic::in_text);
    return RoadMap(std::move(parts));
  });
}

template <typename Rules>
std::vector<validation::RuleInfo> infos_of(const Rules& rules) {
  std::vector<validation::RuleInfo> infos;
  for (const auto& rule : rules) infos.push_back(rule.info);
  return infos;
}

}  // namespace

JudgedFile judge_open_drive(std::string bytes, const std::string& name,
                            const validation::ValidateOptions& options) {
  JudgedFile judged;
  auto xml = parsed(judged, name, [&] { return XmlDocument(std::move(bytes), name); });
  if (!xml) return judged;
  opendrive::Document document = opendrive::read_document(*xml);
  judged.findings = opendrive::rules::check(*xml, document, options);
  judged.lines = opendrive::rules::element_lines(*xml, document);
  judged.suppressions = suppressions_of(*xml);
  read_into(judged, [&] {
    RoadMapParts parts =
        opendrive::read(*std::move(xml), std::move(document), {.max_error_m = options.max_error_m});
    opendrive::rules::mark_told(parts.remarks, judged.findings);
    return parts;
  });
  return judged;
}

JudgedFile judge_lanelet2(std::string bytes, const std::string& name,
                          const validation::ValidateOptions& options) {
  JudgedFile judged;
  const auto unread = [&](const char* message) {  // a line: that of a fault of the XML
    return line_in(message, name) > 0 ? not_well_formed(message, name) : refused(message);
  };
  auto document =
      made(judged, unread, [&] { return lanelet2::read_document(std::move(bytes), name); });
  if (!document) return judged;
  auto built = made(judged, refused, [&] { return lanelet2::build_lanes(*document); });
  const lanelet2::BuiltLanes no_lanes;
  for (const auto& check : {lanelet2::rules::check, lanelet2::autoware::check}) {
    auto findings = check(*document, built ? *built : no_lanes, options);
    std::move(findings.begin(), findings.end(), std::back_inserter(judged.findings));
  }
  judged.lines = lanelet2::rules::element_lines(*document);
  judged.suppressions = suppressions_of(*document, judged.findings);
  if (!built) return judged;
  read_into(judged, [&] { return lanelet2::read(*std::move(document), *std::move(built)); });
  return judged;
}

JudgedFile judge_common_road(std::string bytes, const std::string& name,
                             const validation::ValidateOptions& options) {
  JudgedFile judged;
  const auto document =
      parsed(judged, name, [&] { return commonroad::Document(std::move(bytes), name); });
  if (!document) return judged;
  judged.findings = commonroad::rules::check(*document, options);
  judged.lines = commonroad::rules::element_lines(*document);
  read_into(judged, [&] { return commonroad::read(*document); });
  return judged;
}

std::optional<JudgedFile> judge_unknown_root(const std::string& bytes, const std::string& name) {
  JudgedFile judged;
  const auto xml = parsed(judged, name, [&] { return XmlDocument(bytes, name); });
  if (!xml) return {};
  const pugi::xml_node root = xml->root();
  if (!root.child("header").attribute("revMajor") && !root.child("road").child("planView")) {
    return {};
  }
  validation::Report report(kUnknownRoot, judged.findings);
  judged.refusal = fmt::format(
      "{}:{}: root element <{}> of a file with OpenDRIVE's elements, needs <OpenDRIVE>; rename it",
      name, xml->line_of(root), root.name());
  report
      .add("file", std::nullopt,
           fmt::format("its root element is <{}>, needs <OpenDRIVE>; rename it", root.name()))
      .line = xml->line_of(root);
  return judged;
}

std::vector<validation::RuleInfo> open_drive_rules() {
  return infos_of(opendrive::rules::source_rules());
}

std::vector<validation::RuleInfo> lanelet2_rules() {
  std::vector<validation::RuleInfo> infos = infos_of(lanelet2::rules::source_rules());
  for (const validation::RuleInfo& info : infos_of(lanelet2::autoware::rules())) {
    infos.push_back(info);
  }
  return infos;
}

std::vector<validation::RuleInfo> common_road_rules() {
  return infos_of(commonroad::rules::source_rules());
}

std::vector<validation::RuleInfo> file_rules() { return {kNotWellFormed, kUnknownRoot}; }

}  // namespace roadbed::map
