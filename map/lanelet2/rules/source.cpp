#include "roadbed/map/lanelet2/rules/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>

#include "roadbed/geometry/polygons/polygon.h"

namespace roadbed::map::lanelet2::rules {
namespace {

constexpr double kEarthRadius = 6371e3;  // [m]

using Places = std::vector<Eigen::Vector2d>;

/// Whether two lines that should run side by side begin at opposite ends.
bool is_opposed(const Places& a, const Places& b) {
  const double along = (a.front() - b.front()).norm() + (a.back() - b.back()).norm();
  const double across = (a.front() - b.back()).norm() + (a.back() - b.front()).norm();
  return across < along;
}

/// Whether a border lies to the right of the other one, seen along both.
bool is_to_the_right(const Places& border, const Places& other) {
  geometry::Ring ring = other;
  ring.insert(ring.end(), border.rbegin(), border.rend());
  return geometry::signed_area_m2(ring) < 0.0;
}

}  // namespace

std::string_view tag(pugi::xml_node element, std::string_view key) {
  for (const auto child : element.children("tag")) {
    if (key == child.attribute("k").value()) return child.attribute("v").value();
  }
  return {};
}

std::string Lanelet::element() const {
  return fmt::format("lane {}", node.attribute("id").value());
}

Source::Source(const XmlDocument& document)
    : xml(document), nodes_left_(1'500'000 + document.size_bytes() / 8) {
  for (const auto element : xml.root().children()) read(element);
  if (!node_list.empty()) {
    first_latitude_rad_ =
        xml.optional_number(node_list.front(), "lat").value_or(0.0) * std::numbers::pi / 180.0;
  }
  for (const auto element : relation_list) {
    const std::string_view type = tag(element, "type");
    if (type == "lanelet") lanelets.push_back(lanelet(element));
    if (type == "regulatory_element") regulations.push_back(element);
  }
}

void Source::read(pugi::xml_node element) {
  if (std::strcmp(element.attribute("action").value(), "delete") == 0) return;
  const std::string_view kind = element.name();
  const std::string_view id = element.attribute("id").value();
  if (kind == "node") {
    node_list.push_back(element);
    nodes.emplace(id, element);
  } else if (kind == "way") {
    way_list.push_back(element);
    ways.emplace(id, element);
  } else if (kind == "relation") {
    relation_list.push_back(element);
    relations.emplace(id, element);
  }
}

std::optional<Eigen::Vector2d> Source::local_place(std::string_view node) const {
  const auto found = nodes.find(node);
  if (found == nodes.end()) return {};
  const std::string_view x = tag(found->second, "local_x"), y = tag(found->second, "local_y");
  if (x.empty() || y.empty()) return {};
  const Eigen::Vector2d place(std::strtod(x.data(), nullptr), std::strtod(y.data(), nullptr));
  if (!place.allFinite()) return {};
  return place;
}

std::optional<Eigen::Vector2d> Source::place(std::string_view node) const {
  if (const auto local = local_place(node)) return local;
  const auto found = nodes.find(node);
  if (found == nodes.end()) return {};
  const auto latitude = xml.optional_number(found->second, "lat");
  const auto longitude = xml.optional_number(found->second, "lon");
  if (!latitude || !longitude) return {};
  const double metres_per_degree = kEarthRadius * std::numbers::pi / 180.0;
  return Eigen::Vector2d(*longitude * metres_per_degree * std::cos(first_latitude_rad_),
                         *latitude * metres_per_degree);
}

/// The nodes of all ways of that role, one way after the other as they join.
Nodes Source::border(pugi::xml_node relation, std::string_view role) {
  Nodes border;
  for (const auto member : relation.children("member")) {
    if (role != member.attribute("role").value()) continue;
    const auto way = ways.find(member.attribute("ref").value());
    if (way == ways.end()) return {};
    Nodes part;
    for (const auto reference : way->second.children("nd")) {
      if (nodes_left_ == 0) return {};
      --nodes_left_;
      part.emplace_back(reference.attribute("ref").value());
    }
    if (part.empty()) return {};
    if (!border.empty()) {
      if (border.front() == part.front() || border.front() == part.back()) {
        std::reverse(border.begin(), border.end());
      }
      if (border.back() == part.back()) std::reverse(part.begin(), part.end());
      if (border.back() == part.front()) part.erase(part.begin());
    }
    border.insert(border.end(), part.begin(), part.end());
  }
  return border;
}

Lanelet Source::lanelet(pugi::xml_node relation) {
  Lanelet made{relation, border(relation, "left"), border(relation, "right")};
  Places left, right;
  for (auto [ids, places] : {std::pair{&made.left, &left}, {&made.right, &right}}) {
    for (const std::string_view id : *ids) {
      if (const auto at = place(id)) places->push_back(*at);
    }
  }
  if (left.size() < 2 || right.size() < 2 || left.size() != made.left.size() ||
      right.size() != made.right.size()) {
    return {relation, {}, {}};
  }
  if (is_opposed(left, right)) {
    std::reverse(right.begin(), right.end());
    std::reverse(made.right.begin(), made.right.end());
  }
  if (is_to_the_right(left, right)) {
    std::reverse(made.left.begin(), made.left.end());
    std::reverse(made.right.begin(), made.right.end());
  }
  return made;
}

validation::Finding& add_at(validation::Report& report, const Source& source,
                            const Lanelet& lanelet, std::string message) {
  const auto place = lanelet.left.empty() ? std::nullopt : source.local_place(lanelet.left.front());
  validation::Finding& finding = report.add(lanelet.element(), place, std::move(message));
  finding.line = source.xml.line_of(lanelet.node);
  return finding;
}

validation::Finding& add_at(validation::Report& report, const Source& source,
                            pugi::xml_node element, std::string message) {
  const bool regulation = tag(element, "type") == "regulatory_element";
  validation::Finding& finding =
      report.add(fmt::format("{} {}", regulation ? "regulation" : element.name(),
                             element.attribute("id").value()),
                 std::nullopt, std::move(message));
  finding.line = source.xml.line_of(element);
  return finding;
}

std::vector<SourceRule> source_rules() {
  std::vector<SourceRule> all;
  for (const auto rules : {lanelet_rules(), regulation_rules()}) {
    all.insert(all.end(), rules.begin(), rules.end());
  }
  return all;
}

validation::ElementLines element_lines(const XmlDocument& xml) {
  validation::ElementLines lines;
  for (const auto element : xml.root().children("relation")) {
    const std::string_view type = tag(element, "type");
    const char* kind = type == "lanelet" ? "lane" : "regulation";
    if (type != "lanelet" && type != "regulatory_element") continue;
    lines.emplace(fmt::format("{} {}", kind, element.attribute("id").value()),
                  xml.line_of(element));
  }
  return lines;
}

}  // namespace roadbed::map::lanelet2::rules
