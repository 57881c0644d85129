#include "roadbed/map/judged_file.h"

#include <charconv>
#include <utility>

#include "roadbed/map/commonroad/read.h"
#include "roadbed/map/commonroad/rules/source.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/lanelet2/read.h"
#include "roadbed/map/lanelet2/rules/source.h"
#include "roadbed/map/opendrive/read.h"
#include "roadbed/map/opendrive/rules/source.h"

namespace roadbed::map {
namespace {

constexpr validation::RuleInfo kNotWellFormed = {
    "source.not-well-formed", "asam.net:xodr:1.0.0:xml.valid_xml_document",
    validation::Severity::error, "the file is no well-formed XML"};

/// Runs the rules of one format over a tree.
template <typename Source, typename Rules>
std::vector<validation::Finding> check(const XmlDocument& xml, const Rules& rules,
                                       const validation::ValidateOptions& options) {
  std::vector<validation::Finding> findings;
  const Source source(xml);
  for (const auto& rule : rules) {
    validation::Report report(rule.info, findings);
    rule.check(source, options, report);
    report.finish();
  }
  return findings;
}

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

/// The tree of the text; none if it is not well-formed, which then is what is found.
std::optional<XmlDocument> tree_of(std::string bytes, const std::string& name, JudgedFile& judged) {
  try {
    return std::optional<XmlDocument>(std::in_place, std::move(bytes), name);
  } catch (const InputError& error) {
    judged.refusal = error.what();
    judged.findings.push_back(not_well_formed(error.what(), name));
    return {};
  }
}

template <typename Read>
void read_into(JudgedFile& judged, const Read& read) {
  try {
    judged.road_map = read();
  } catch (const InputError& error) {
    judged.refusal = error.what();
    judged.findings.push_back(refused(error.what()));
  }
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
  auto xml = tree_of(std::move(bytes), name, judged);
  if (!xml) return judged;
  opendrive::Document document = opendrive::read_document(*xml);
  judged.findings = opendrive::rules::check(*xml, document, options);
  judged.lines = opendrive::rules::element_lines(*xml, document);
  read_into(judged,
            [&] { return RoadMap(opendrive::read(*std::move(xml), std::move(document), {})); });
  return judged;
}

JudgedFile judge_lanelet2(std::string bytes, const std::string& name,
                          const validation::ValidateOptions& options) {
  JudgedFile judged;
  if (const auto xml = tree_of(bytes, name, judged)) {
    judged.findings =
        check<lanelet2::rules::Source>(*xml, lanelet2::rules::source_rules(), options);
    judged.lines = lanelet2::rules::element_lines(*xml);
  } else {
    return judged;
  }
  read_into(judged, [&] { return RoadMap(lanelet2::read(bytes, name)); });
  return judged;
}

JudgedFile judge_common_road(std::string bytes, const std::string& name,
                             const validation::ValidateOptions& options) {
  JudgedFile judged;
  const auto xml = tree_of(std::move(bytes), name, judged);
  if (!xml) return judged;
  judged.findings =
      check<commonroad::rules::Source>(*xml, commonroad::rules::source_rules(), options);
  judged.lines = commonroad::rules::element_lines(*xml);
  read_into(judged, [&] { return RoadMap(commonroad::read(*xml)); });
  return judged;
}

std::vector<validation::RuleInfo> open_drive_rules() {
  return infos_of(opendrive::rules::source_rules());
}

std::vector<validation::RuleInfo> lanelet2_rules() {
  return infos_of(lanelet2::rules::source_rules());
}

std::vector<validation::RuleInfo> common_road_rules() {
  return infos_of(commonroad::rules::source_rules());
}

validation::RuleInfo well_formed_rule() { return kNotWellFormed; }

}  // namespace roadbed::map
