#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/opendrive/rules/schema_grammar.h"
#include "roadbed/map/opendrive/rules/source.h"

// What the schema of the file's revision, 1.4 to 1.8, asks for. What the program needs is asked of
// files of every revision.

namespace roadbed::map::opendrive::rules {
namespace {

constexpr std::string_view kValidSchema = "asam.net:xodr:1.0.0:xml.valid_schema";

/// What a number outside its range is: "is less than 0".
std::string_view miss_of(Range range) {
  switch (range) {
    case Range::any:
      break;
    case Range::not_negative:
      return "is less than 0";
    case Range::positive:
      return "is not greater than 0";
    case Range::negative:
      return "is not less than 0";
    case Range::zero:
      return "is not 0";
    case Range::share:
      return "is not between 0 and 1";
  }
  return {};
}

/// The last digit of the file's revision; 0 if it is none of 1.x.
int minor_revision(const XmlDocument& xml) {
  const auto header = xml.root().child("header");
  if (xml.optional_integer(header, "revMajor") != 1) return 0;
  return xml.optional_integer(header, "revMinor").value_or(0);
}

class Checker {
 public:
  explicit Checker(const XmlDocument& xml) : xml_(xml), grammar_(minor_revision(xml)) {}

  std::vector<SchemaFault> run() {
    check(xml_.root(), grammar_.root());
    return std::move(faults_);
  }

 private:
  using Kind = SchemaFault::Kind;

  void add(Kind kind, pugi::xml_node node, std::string message) {
    constexpr std::size_t kMost =
        2 * validation::Report::kMost;  // a file may be nothing but faults
    if (++count_[static_cast<std::size_t>(kind)] > kMost) return;
    faults_.push_back({kind, node, std::move(message)});
  }

  void check(pugi::xml_node node, const ElementRule& element) {
    pugi::xml_attribute next;  // files have attributes in the order of the table, mostly
    for (const AttributeRule& rule : element.attributes) check_attribute(node, rule, next);
    for (const ChildRule& rule : element.children) {
      if (rule.is_required && !node.child(rule.name.c_str())) add_missing(node, rule);
    }
    if (element.type == "geometry") check_curve(node);
    std::size_t hint = 0;
    for (const pugi::xml_node child : node.children()) {
      if (child.type() != pugi::node_element) continue;
      if (const ElementRule* rule = element.child(child.name(), hint)) check(child, *rule);
    }
  }

  void add_missing(pugi::xml_node node, const ChildRule& rule) {
    if (rule.is_vital) {
      add(Kind::missing_element, node,
          fmt::format("has no <{}>, which it must have; add one", rule.name));
    } else {
      add(Kind::incomplete, node,
          fmt::format("has no <{}>, which revision 1.{} asks for; add one", rule.name,
                      grammar_.minor()));
    }
  }

  void check_curve(pugi::xml_node node) {
    const auto is_element = [](pugi::xml_node one) { return one.type() == pugi::node_element; };
    if (node.find_child(is_element)) return;
    add(Kind::missing_element, node, "has no curve; add a line, arc, spiral, poly3 or paramPoly3");
  }

  void check_attribute(pugi::xml_node node, const AttributeRule& rule, pugi::xml_attribute& next) {
    const pugi::xml_attribute found = node.attribute(rule.name.c_str(), next);
    if (found) {
      check_value(node, rule, found);
    } else if (rule.is_vital) {
      add(Kind::missing_attribute, node, fmt::format("has no attribute {}; add it", rule.name));
    } else if (rule.is_required) {
      add(Kind::incomplete, node,
          fmt::format("has no attribute {}, which revision 1.{} asks for; add it", rule.name,
                      grammar_.minor()));
    }
  }

  void check_value(pugi::xml_node node, const AttributeRule& rule, pugi::xml_attribute found) {
    switch (rule.type.kind) {
      case ValueType::Kind::text:
        return;
      case ValueType::Kind::filled:
        if (*found.value() != '\0') return;
        return add(Kind::invalid_value, node,
                   fmt::format("{}=\"\" is empty; correct it", rule.name));
      case ValueType::Kind::number:
        return check_number(node, rule, found, number_of(node, found), "finite");
      case ValueType::Kind::whole:
        return check_number(node, rule, found, xml_.optional_integer(node, found.name()), "whole");
      case ValueType::Kind::choice:
        return check_choice(node, *rule.type.choice, found);
    }
  }

  std::optional<double> number_of(pugi::xml_node node, pugi::xml_attribute found) const {
    return xml_.optional_number(node, found.name(), found);
  }

  void check_number(pugi::xml_node node, const AttributeRule& rule, pugi::xml_attribute found,
                    std::optional<double> value, std::string_view kind) {
    if (!value) {
      add(rule.is_vital ? Kind::not_a_number : Kind::invalid_value, node,
          fmt::format("{}=\"{}\" is no {} number; correct it", rule.name, found.value(), kind));
    } else if (!is_in(rule.type.range, *value)) {
      add(Kind::invalid_value, node,
          fmt::format("{}=\"{}\" {}; correct it", rule.name, found.value(),
                      miss_of(rule.type.range)));
    }
  }

  void check_choice(pugi::xml_node node, const Choice& choice, pugi::xml_attribute found) {
    const std::string_view value = found.value();
    if (choice.has(value) || is_allowed_number(node, choice, found)) return;
    const bool is_of_others =
        std::find(choice.others.begin(), choice.others.end(), value) != choice.others.end();
    add(Kind::unknown_value, node,
        is_of_others ? fmt::format("{}=\"{}\" is no value of revision 1.{}; correct it",
                                   found.name(), value, grammar_.minor())
                     : fmt::format("{}=\"{}\" is no value of the standard; correct it",
                                   found.name(), value));
  }

  bool is_allowed_number(pugi::xml_node node, const Choice& choice,
                         pugi::xml_attribute found) const {
    if (!choice.range) return false;
    const std::optional<double> value = number_of(node, found);
    return value && is_in(*choice.range, *value);
  }

  const XmlDocument& xml_;
  const Grammar grammar_;
  std::vector<SchemaFault> faults_;
  std::array<std::size_t, SchemaFault::kKinds> count_{};  ///< by kind
};

/// "<width> of lane -1 of road 12".
std::string describe(pugi::xml_node node) {
  std::string text = fmt::format("<{}>", node.name());
  for (pugi::xml_node up = node; up; up = up.parent()) {
    const std::string_view kind = up.name();
    if (up == node && kind != "lane" && kind != "road") continue;
    if (kind == "road" || kind == "junction" || kind == "lane" || kind == "signal") {
      text += fmt::format(" of {} {}", kind, up.attribute("id").value());
    }
  }
  return text;
}

template <SchemaFault::Kind kind>
void schema_faults(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  for (const SchemaFault& fault : source.schema_faults) {
    if (fault.kind != kind) continue;
    report.add(describe(fault.node), std::nullopt, fault.message).line =
        source.xml.line_of(fault.node);
  }
}

using Kind = SchemaFault::Kind;

constexpr std::array<SourceRule, SchemaFault::kKinds> kSchemaRules = {{
    {{"schema.missing-element", kValidSchema, validation::Severity::error,
      "an element that the standard asks for is missing"},
     schema_faults<Kind::missing_element>},
    {{"schema.missing-attribute", kValidSchema, validation::Severity::error,
      "an attribute that the standard asks for is missing"},
     schema_faults<Kind::missing_attribute>},
    {{"schema.not-a-number", kValidSchema, validation::Severity::error,
      "an attribute is not the (finite or whole) number that it has to be"},
     schema_faults<Kind::not_a_number>},
    {{"schema.unknown-value", kValidSchema, validation::Severity::warning,
      "an attribute has none of the values that the standard knows"},
     schema_faults<Kind::unknown_value>},
    {{"schema.incomplete", kValidSchema, validation::Severity::warning,
      "what the file's revision asks for is missing, and the program does without"},
     schema_faults<Kind::incomplete>},
    {{"schema.invalid-value", kValidSchema, validation::Severity::warning,
      "an attribute is out of its range, or no number where the program needs none"},
     schema_faults<Kind::invalid_value>},
}};

}  // namespace

std::vector<SchemaFault> find_schema_faults(const XmlDocument& xml) { return Checker(xml).run(); }

std::span<const SourceRule> schema_rules() { return kSchemaRules; }

}  // namespace roadbed::map::opendrive::rules
