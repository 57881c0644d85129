#include "roadbed/map/source_rules.h"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "roadbed/map/commonroad/rules/source.h"
#include "roadbed/map/lanelet2/rules/source.h"
#include "roadbed/map/opendrive/document.h"
#include "roadbed/map/opendrive/rules/source.h"

namespace roadbed::map {
namespace {

constexpr validation::RuleInfo kNotWellFormed = {
    "source.not-well-formed", "asam.net:xodr:1.0.0:xml.valid_xml_document",
    validation::Severity::error, "the file is no well-formed XML"};

enum class Format { unknown, open_drive, lanelet2, common_road };

Format format_of(const XmlDocument& xml) {
  const std::string_view root = xml.root().name();
  if (opendrive::is_open_drive(xml.root().name())) return Format::open_drive;
  if (root == "osm") return Format::lanelet2;
  return root == "commonRoad" ? Format::common_road : Format::unknown;
}

/// Runs the rules of one format over a document.
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

}  // namespace

std::vector<validation::Finding> check_source(const XmlDocument& xml,
                                              const validation::ValidateOptions& options) {
  switch (format_of(xml)) {
    case Format::open_drive:
      return check<opendrive::rules::Source>(xml, opendrive::rules::source_rules(), options);
    case Format::lanelet2:
      return check<lanelet2::rules::Source>(xml, lanelet2::rules::source_rules(), options);
    case Format::common_road:
      return check<commonroad::rules::Source>(xml, commonroad::rules::source_rules(), options);
    case Format::unknown:
      return {};
  }
  return {};
}

validation::ElementLines element_lines(const XmlDocument& xml) {
  switch (format_of(xml)) {
    case Format::open_drive:
      return opendrive::rules::element_lines(xml);
    case Format::lanelet2:
      return lanelet2::rules::element_lines(xml);
    case Format::common_road:
      return commonroad::rules::element_lines(xml);
    case Format::unknown:
      return {};
  }
  return {};
}

bool names_known_format(const std::string& bytes) {
  const std::string_view start = std::string_view(bytes).substr(0, 100'000);
  const auto names = [&](std::string_view text) { return start.find(text) != start.npos; };
  return names("<OpenDRIVE") || names(":OpenDRIVE") || names("<commonRoad") || names("<osm");
}

validation::Finding not_well_formed(const std::string& name, const std::string& message) {
  std::vector<validation::Finding> findings;
  validation::Report report(kNotWellFormed, findings);
  report.add("file", std::nullopt, message).line = line_in(message, name);
  return findings.front();
}

std::vector<validation::RuleInfo> source_rule_infos() {
  std::vector<validation::RuleInfo> infos{kNotWellFormed};
  for (const auto& rule : opendrive::rules::source_rules()) infos.push_back(rule.info);
  for (const auto& rule : lanelet2::rules::source_rules()) infos.push_back(rule.info);
  for (const auto& rule : commonroad::rules::source_rules()) infos.push_back(rule.info);
  return infos;
}

}  // namespace roadbed::map
