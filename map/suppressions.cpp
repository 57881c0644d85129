#include "roadbed/map/suppressions.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map {
namespace {

constexpr const char* kKey = "roadbed:suppress";

/// The texts between commas, without blanks around them.
std::vector<std::string> patterns_in(std::string_view text) {
  std::vector<std::string> patterns;
  while (!text.empty()) {
    std::string_view part = text.substr(0, text.find(','));
    text.remove_prefix(std::min(part.size() + 1, text.size()));
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    if (!part.empty()) patterns.emplace_back(part);
  }
  return patterns;
}

void add(validation::Suppressions& suppressions, const std::string& element,
         std::string_view text) {
  auto patterns = patterns_in(text);
  auto& all = suppressions[element];
  std::move(patterns.begin(), patterns.end(), std::back_inserter(all));
}

/// "lane 12/0/-1" of a <lane>: road, index of the section, lane.
std::string lane_element(pugi::xml_node lane) {
  const pugi::xml_node section = lane.parent().parent(), road = section.parent().parent();
  int index = 0;
  for (auto before = section.previous_sibling("laneSection"); before;
       before = before.previous_sibling("laneSection")) {
    ++index;
  }
  return fmt::format("lane {}/{}/{}", road.attribute("id").value(), index,
                     lane.attribute("id").value());
}

/// How findings name an element of an OpenDRIVE file, or the part of the map that it belongs to.
std::string open_drive_element(pugi::xml_node node) {
  for (; node; node = node.parent()) {
    const std::string_view name = node.name();
    if (name == "lane") return lane_element(node);
    if (name == "road" || name == "signal" || name == "object" || name == "junction" ||
        name == "controller") {
      return fmt::format("{} {}", name, node.attribute("id").value());
    }
  }
  return "map";
}

/// Finds the user data of a tree.
struct UserDataWalker : pugi::xml_tree_walker {
  validation::Suppressions found;

  bool for_each(pugi::xml_node& node) override {
    if (std::string_view(node.name()) == "userData" &&
        std::string_view(node.attribute("code").value()) == kKey) {
      add(found, open_drive_element(node.parent()), node.attribute("value").value());
    }
    return true;
  }
};

/// "12" of "lane 12" and of "stop line 12".
std::string_view id_of(std::string_view element) { return element.substr(element.rfind(' ') + 1); }

/// The element of an OSM file that a finding's element is: kinds of things that are relations, and
/// those that are ways.
std::string osm_element(std::string_view element) {
  const bool is_relation = element.starts_with("lane ") || element.starts_with("regulation ") ||
                           element.starts_with("relation ") || element.starts_with("area ");
  const bool is_node = element.starts_with("node ");
  return fmt::format("{} {}", is_relation ? "relation" : is_node ? "node" : "way", id_of(element));
}

/// "road 12" of "lane 12/0/-1"; nothing of another element.
std::string road_of(std::string_view element) {
  const std::size_t slash = element.find('/');
  if (!element.starts_with("lane ") || slash == std::string_view::npos) return {};
  return "road " + std::string(element.substr(5, slash - 5));
}

bool is_suppressed(const validation::Finding& finding,
                   const validation::Suppressions& suppressions) {
  for (const std::string& element : {finding.element, osm_element(finding.element),
                                     road_of(finding.element), std::string("map")}) {
    const auto found = suppressions.find(element);
    if (found == suppressions.end()) continue;
    const auto fits = [&](const std::string& pattern) {
      return validation::fits(pattern, finding);
    };
    if (std::ranges::any_of(found->second, fits)) return true;
  }
  return false;
}

}  // namespace

validation::Suppressions suppressions_of(const XmlDocument& xml) {
  UserDataWalker walker;
  xml.root().traverse(walker);
  return std::move(walker.found);
}

validation::Suppressions suppressions_of(const lanelet2::Document& document,
                                         const std::vector<validation::Finding>& findings) {
  validation::Suppressions suppressions;
  const auto add_tags = [&](const char* kind, const auto& elements) {
    for (const auto& element : elements) {
      const std::string_view text = lanelet2::value_of(element.tags, kKey);
      if (!text.empty()) add(suppressions, fmt::format("{} {}", kind, element.id), text);
    }
  };
  add_tags("relation", document.relations);
  add_tags("way", document.ways);
  for (const validation::Finding& finding : findings) {
    if (!finding.element.starts_with("node ") || suppressions.contains(finding.element)) continue;
    const auto id = lanelet2::id_in(id_of(finding.element));
    const auto place = id ? document.node_index.find(*id) : std::nullopt;
    if (!place) continue;
    for (const auto& [key, value] : document.tags_of(document.nodes[*place].at)) {
      if (key == kKey) add(suppressions, finding.element, value);
    }
  }
  return suppressions;
}

std::vector<validation::Finding> take_suppressed(std::vector<validation::Finding>& findings,
                                                 const validation::Suppressions& suppressions) {
  if (suppressions.empty()) return {};
  const auto kept = std::stable_partition(
      findings.begin(), findings.end(),
      [&](const validation::Finding& finding) { return !is_suppressed(finding, suppressions); });
  std::vector<validation::Finding> taken(std::make_move_iterator(kept),
                                         std::make_move_iterator(findings.end()));
  findings.erase(kept, findings.end());
  return taken;
}

}  // namespace roadbed::map
