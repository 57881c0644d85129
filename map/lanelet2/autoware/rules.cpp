#include "roadbed/map/lanelet2/autoware/rules.h"

#include <fmt/format.h>

#include <algorithm>

namespace roadbed::map::lanelet2::autoware {
namespace {

validation::Finding too_many_overlaps() {
  return {.rule = "import.too-many-overlaps",
          .asam_rule = {},
          .severity = validation::Severity::info,
          .element = "map",
          .line = 0,
          .in_map = std::nullopt,
          .message =
              "so many lanelets and areas lie on each other that Autoware's rules about "
              "shapes looked at a part of them only"};
}

}  // namespace

std::vector<Rule> rules() {
  std::vector<Rule> all;
  for (const auto some :
       {area_rules(), crosswalk_rules(), intersection_area_rules(), turn_rules(),
        right_of_way_rules(), virtual_light_rules(), lane_tag_rules(), lane_side_rules(),
        lane_shape_rules(), stop_line_rules(), traffic_light_rules()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

std::vector<validation::Finding> check(const Document& document, const BuiltLanes& built,
                                       const validation::ValidateOptions& options) {
  const std::vector<Rule> all = rules();
  const auto is_asked_for = [&](const Rule& rule) { return options.choice.asks_for(rule.info); };
  if (std::ranges::none_of(all, is_asked_for)) return {};
  const rules::Source source(document, built);
  const VectorMap map(source, built);
  std::vector<validation::Finding> findings = validation::findings_of(all, map, options);
  if (map.budget().is_spent()) findings.push_back(too_many_overlaps());
  return findings;
}

std::string ids_text(const std::vector<std::int64_t>& ids) {
  constexpr std::size_t kMost = 10;
  std::string text;
  for (std::size_t i = 0; i < std::min(ids.size(), kMost); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", ids[i]);
  }
  if (ids.size() > kMost) text += fmt::format(" and {} more", ids.size() - kMost);
  return text;
}

}  // namespace roadbed::map::lanelet2::autoware
