#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/lanelet2/autoware/vector_map.h"
#include "roadbed/map/validation/rule.h"

namespace roadbed::map::lanelet2::autoware {

/// One of Autoware's requirements of a vector map. It may find several issues, which have numbers.
struct Rule {
  validation::RuleInfo info;
  void (*check)(const VectorMap& map, const validation::ValidateOptions& options,
                validation::Report& report);
};

std::span<const Rule> area_rules();               ///< detection, no stopping, bus stop, buffer zone
std::span<const Rule> crosswalk_rules();          ///< crosswalks
std::span<const Rule> intersection_area_rules();  ///< intersection areas and lanelets in them
std::span<const Rule> turn_rules();               ///< turn directions and turn signals
std::span<const Rule> right_of_way_rules();       ///< who yields to whom
std::span<const Rule> virtual_light_rules();      ///< virtual traffic lights
std::span<const Rule> lane_tag_rules();           ///< tags of lanelets and their borders
std::span<const Rule> lane_side_rules();          ///< lanelets beside and behind each other
std::span<const Rule> lane_shape_rules();         ///< borders and centrelines
std::span<const Rule> stop_line_rules();          ///< stop lines, road markings, traffic signs
std::span<const Rule> traffic_light_rules();      ///< traffic lights

/// All of the above, the 42 requirements of autoware_lanelet2_map_validator.
std::vector<Rule> rules();

/// What the rules that are asked for find in a document.
/// @param built  of the document; without lanes where none could be built.
std::vector<validation::Finding> check(const Document& document, const BuiltLanes& built,
                                       const validation::ValidateOptions& options);

/// What rules/source.h names a finding's element by.
inline const rules::Lanelet& text_of(const Lanelet& lanelet) { return *lanelet.text; }
template <typename Element>
const Element& text_of(const Element& element) {
  return element;
}

/// The rule's issue with that number ("…-001") about a part of the map, with its line and place.
/// As grave as the rule, unless the caller makes it something else.
template <typename Element>
validation::Finding& add_issue(validation::Report& report, const VectorMap& map, int number,
                               const Element& element, std::string message) {
  validation::Finding& finding =
      rules::add_at(report, map.source(), text_of(element), std::move(message));
  finding.autoware_issue = report.autoware_issue(number);
  finding.in_map = map.place(element);
  return finding;
}

/// "12, 13, 14": of the first ten, and how many there are besides.
std::string ids_text(const std::vector<std::int64_t>& ids);

}  // namespace roadbed::map::lanelet2::autoware
