#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <unordered_map>

#include "roadbed/map/opendrive/rules/source.h"

// What every schema of OpenDRIVE 1.4 to 1.8 asks for of the elements that carry the road network.

namespace roadbed::map::opendrive::rules {
namespace {

constexpr std::string_view kValidSchema = "asam.net:xodr:1.0.0:xml.valid_schema";

enum class Type { text, number, whole };

struct Attribute {
  std::string_view name;
  Type type = Type::number;
};

struct Element {
  std::string_view parent, name;
  std::vector<Attribute> required;
  std::vector<std::string_view> children;  ///< of each at least one
};

std::vector<Attribute> cubic(std::string_view s_attribute) {
  return {{s_attribute}, {"a"}, {"b"}, {"c"}, {"d"}};
}

const std::vector<Element>& elements() {
  static const std::vector<Element> all = {
      {"OpenDRIVE", "road", {{"id", Type::text}, {"length"}}, {"planView", "lanes"}},
      {"road", "planView", {}, {"geometry"}},
      {"planView", "geometry", {{"s"}, {"x"}, {"y"}, {"hdg"}, {"length"}}, {}},
      {"geometry", "arc", {{"curvature"}}, {}},
      {"geometry", "spiral", {{"curvStart"}, {"curvEnd"}}, {}},
      {"geometry", "poly3", {{"a"}, {"b"}, {"c"}, {"d"}}, {}},
      {"geometry",
       "paramPoly3",
       {{"aU"}, {"bU"}, {"cU"}, {"dU"}, {"aV"}, {"bV"}, {"cV"}, {"dV"}},
       {}},
      {"elevationProfile", "elevation", cubic("s"), {}},
      {"lateralProfile", "superelevation", cubic("s"), {}},
      {"lanes", "laneOffset", cubic("s"), {}},
      {"road", "lanes", {}, {"laneSection"}},
      {"lanes", "laneSection", {{"s"}}, {"center"}},
      {"left", "lane", {{"id", Type::whole}, {"type", Type::text}}, {}},
      {"right", "lane", {{"id", Type::whole}, {"type", Type::text}}, {}},
      {"center", "lane", {{"id", Type::whole}}, {}},
      {"lane", "width", cubic("sOffset"), {}},
      {"lane", "border", cubic("sOffset"), {}},
      {"lane", "roadMark", {{"sOffset"}, {"type", Type::text}}, {}},
      {"lane", "speed", {{"sOffset"}, {"max"}}, {}},
      {"road", "type", {{"s"}, {"type", Type::text}}, {}},
      {"OpenDRIVE", "junction", {{"id", Type::text}}, {}},
      {"junction", "connection", {{"id", Type::text}}, {}},
      {"connection", "laneLink", {{"from", Type::whole}, {"to", Type::whole}}, {}},
      {"signals", "signal", {{"id", Type::text}, {"s"}, {"t"}}, {}},
      {"signals", "signalReference", {{"id", Type::text}, {"s"}, {"t"}}, {}},
      {"objects", "object", {{"s"}, {"t"}}, {}},
      {"signal", "validity", {{"fromLane", Type::whole}, {"toLane", Type::whole}}, {}},
      {"OpenDRIVE", "controller", {{"id", Type::text}}, {}},
      {"controller", "control", {{"signalId", Type::text}}, {}},
  };
  return all;
}

struct Choice {
  std::string_view element, attribute;
  std::vector<std::string_view> values;
};

const std::vector<Choice>& choices() {
  static const std::vector<Choice> all = {
      {"predecessor", "contactPoint", {"start", "end"}},
      {"successor", "contactPoint", {"start", "end"}},
      {"predecessor", "elementType", {"road", "junction"}},
      {"successor", "elementType", {"road", "junction"}},
      {"connection", "contactPoint", {"start", "end"}},
      {"road", "rule", {"RHT", "LHT"}},
      {"junction", "type", {"default", "common", "direct", "virtual", "crossing"}},
      {"paramPoly3", "pRange", {"arcLength", "normalized"}},
      {"lane", "level", {"true", "false", "1", "0"}},
      {"lane", "direction", {"standard", "reversed", "both"}},
      {"lane",
       "type",
       {"none",       "driving",        "stop",  "shoulder",      "biking", "sidewalk", "border",
        "restricted", "parking",        "curb",  "bidirectional", "median", "special1", "special2",
        "special3",   "tram",           "rail",  "roadWorks",     "entry",  "exit",     "offRamp",
        "onRamp",     "connectingRamp", "bus",   "taxi",          "HOV",    "mwyEntry", "mwyExit",
        "walking",    "slipLane",       "shared"}},
  };
  return all;
}

// Elements and attributes by name; names are few, so that a list under a hash is short.
template <typename Entry>
using ByName = std::unordered_map<std::string_view, std::vector<const Entry*>>;

const ByName<Element>& elements_by_name() {
  static const ByName<Element> table = [] {
    ByName<Element> made;
    for (const Element& element : elements()) made[element.name].push_back(&element);
    return made;
  }();
  return table;
}

const ByName<Choice>& choices_by_element() {
  static const ByName<Choice> table = [] {
    ByName<Choice> made;
    for (const Choice& choice : choices()) made[choice.element].push_back(&choice);
    return made;
  }();
  return table;
}

bool is_whole(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

class Checker : public pugi::xml_tree_walker {
 public:
  explicit Checker(const XmlDocument& xml) : xml_(xml) {}

  bool for_each(pugi::xml_node& node) override {
    if (node.type() != pugi::node_element) return true;
    const auto entries = elements_by_name().find(node.name());
    if (entries != elements_by_name().end()) {
      for (const Element* element : entries->second) {
        if (element->parent == node.parent().name()) check(node, *element);
      }
    }
    const auto choice = choices_by_element().find(node.name());
    if (choice != choices_by_element().end()) {
      for (const Choice* one : choice->second) check(node, *one);
    }
    return true;
  }

  std::vector<SchemaFault> take() { return std::move(faults_); }

 private:
  void add(SchemaFault::Kind kind, pugi::xml_node node, std::string message) {
    constexpr std::size_t kMost =
        2 * validation::Report::kMost;  // a file may be nothing but faults
    if (++count_[static_cast<std::size_t>(kind)] > kMost) return;
    faults_.push_back({kind, node, std::move(message)});
  }

  void check(pugi::xml_node node, const Element& element) {
    for (const Attribute& attribute : element.required) check(node, attribute);
    for (const std::string_view child : element.children) {
      if (node.child(child.data())) continue;
      add(SchemaFault::Kind::missing_element, node,
          fmt::format("has no <{}>, which it must have; add one", child));
    }
    const auto is_element = [](pugi::xml_node one) { return one.type() == pugi::node_element; };
    if (element.name == "geometry" && !node.find_child(is_element)) {
      add(SchemaFault::Kind::missing_element, node,
          "has no curve; add a line, arc, spiral, poly3 or paramPoly3");
    }
  }

  void check(pugi::xml_node node, const Attribute& attribute) {
    const pugi::xml_attribute found = node.attribute(attribute.name.data());
    if (!found) {
      add(SchemaFault::Kind::missing_attribute, node,
          fmt::format("has no attribute {}; add it", attribute.name));
    } else if ((attribute.type == Type::number &&
                !xml_.optional_number(node, attribute.name.data())) ||
               (attribute.type == Type::whole && !is_whole(found.value()))) {
      add(SchemaFault::Kind::not_a_number, node,
          fmt::format("{}=\"{}\" is no {}; correct it", attribute.name, found.value(),
                      attribute.type == Type::whole ? "whole number" : "finite number"));
    }
  }

  void check(pugi::xml_node node, const Choice& choice) {
    const pugi::xml_attribute found = node.attribute(choice.attribute.data());
    if (!found || std::find(choice.values.begin(), choice.values.end(), found.value()) !=
                      choice.values.end()) {
      return;
    }
    if (choice.element == "predecessor" || choice.element == "successor") {
      if (std::string_view(node.parent().parent().name()) != "road") return;
    }
    add(SchemaFault::Kind::unknown_value, node,
        fmt::format("{}=\"{}\" is no value of the standard; correct it", choice.attribute,
                    found.value()));
  }

  const XmlDocument& xml_;
  std::vector<SchemaFault> faults_;
  std::array<std::size_t, 4> count_{};  ///< by kind
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

constexpr std::array<SourceRule, 4> kSchemaRules = {{
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
}};

}  // namespace

std::vector<SchemaFault> find_schema_faults(const XmlDocument& xml) {
  Checker checker(xml);
  pugi::xml_node root = xml.root();
  root.traverse(checker);
  return checker.take();
}

std::span<const SourceRule> schema_rules() { return kSchemaRules; }

}  // namespace roadbed::map::opendrive::rules
