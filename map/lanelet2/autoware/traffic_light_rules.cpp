#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "roadbed/map/lanelet2/autoware/light_facing.h"
#include "roadbed/map/lanelet2/autoware/regulation_members.h"
#include "roadbed/map/lanelet2/autoware/rules.h"
#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using validation::Report;
using validation::ValidateOptions;

bool is_light(const Way& way) { return way.type == "traffic_light" && !is_area(way); }

bool has_tag(const Way& way, std::string_view key) {
  return std::ranges::any_of(way.tags, [&](const Tag& tag) { return tag.first == key; });
}

void unregulated_lights(const VectorMap& map, const ValidateOptions&, Report& report) {
  std::set<std::int64_t> referred;
  for (const Relation* regulation : map.regulations()) {
    if (regulation->subtype != "traffic_light") continue;
    for (const Way* light : map.lines(*regulation, "refers")) referred.insert(light->id);
  }
  for (const Way& way : map.document().ways) {
    if (!is_light(way) || referred.contains(way.id)) continue;
    add_issue(report, map, 1, way,
              "no traffic_light regulatory element refers to this light, so that nobody looks at "
              "it; add one");
  }
}

void missing_referrers(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Relation* regulation : map.regulations()) {
    if (regulation->subtype != "traffic_light" || !map.users(*regulation).empty()) continue;
    add_issue(report, map, 1, *regulation,
              "no lanelet names this traffic light; add it to the lanelets that it holds for");
  }
}

void body_heights(const VectorMap& map, const ValidateOptions&, Report& report) {
  constexpr double kLeast_m = 0.2, kMost_m = 2.0;  // Autoware's range
  for (const Way& way : map.document().ways) {
    if (!is_light(way)) continue;
    if (!has_tag(way, "height")) {
      add_issue(report, map, 1, way, "is a traffic light without height; add that of its body [m]");
      continue;
    }
    const std::string_view text = value_of(way.tags, "height");
    const double height_m = number_in(text);
    if (height_m >= kLeast_m && height_m <= kMost_m) continue;
    add_issue(report, map, 2, way,
              fmt::format("is a traffic light with height \"{}\", not between {} and {} m; give "
                          "that of its body",
                          text, kLeast_m, kMost_m));
  }
}

void check_bulb(const VectorMap& map, Report& report, const Node& bulb) {
  constexpr std::array<std::string_view, 3> kColours = {"red", "yellow", "green"};
  constexpr std::array<std::string_view, 5> kArrows = {"up", "right", "left", "up_right",
                                                       "up_left"};
  const Attributes tags = map.document().tags_of(bulb.at);
  const auto value = [&](std::string_view key) -> const std::string* {
    const auto found =
        std::ranges::find_if(tags, [&](const auto& tag) { return tag.first == key; });
    return found == tags.end() ? nullptr : &found->second;
  };
  const std::string *colour = value("color"), *arrow = value("arrow");
  if (colour == nullptr) {
    add_issue(report, map, 1, bulb, "is a light bulb without color; add red, yellow or green");
  } else if (std::ranges::count(kColours, *colour) == 0) {
    add_issue(
        report, map, 2, bulb,
        fmt::format("is a light bulb of color \"{}\"; make it red, yellow or green", *colour));
  }
  if (arrow != nullptr && std::ranges::count(kArrows, *arrow) == 0) {
    add_issue(report, map, 3, bulb,
              fmt::format("is a light bulb with arrow \"{}\"; make it up, right, left, up_right or "
                          "up_left",
                          *arrow));
  }
}

void light_bulbs(const VectorMap& map, const ValidateOptions&, Report& report) {
  std::set<const Way*> looked_at;
  for (const Relation* regulation : map.regulations()) {
    for (const Way* bulbs : map.lines(*regulation, "light_bulbs")) {
      if (!looked_at.insert(bulbs).second) continue;
      for (const std::uint32_t node : bulbs->nodes) {
        check_bulb(map, report, map.document().nodes[node]);
      }
    }
  }
}

bool is_for_pedestrians(const std::vector<const Way*>& lights) {
  return std::ranges::all_of(lights,
                             [](const Way* light) { return light->subtype == "red_green"; });
}

bool is_for_crosswalks(const VectorMap& map, const Relation& regulation) {
  return std::ranges::all_of(map.users(regulation),
                             [](const Lanelet* user) { return user->subtype() == "crosswalk"; });
}

/// Whether each light is named by bulbs, and all bulbs name one of the lights.
bool belong_together(const std::vector<const Way*>& lights, const std::vector<const Way*>& bulbs) {
  std::set<std::int64_t> ids, named;
  for (const Way* light : lights) ids.insert(light->id);
  for (const Way* line : bulbs) {
    const auto id = id_in(value_of(line->tags, "traffic_light_id"));
    if (!id || !ids.contains(*id)) return false;
    named.insert(*id);
  }
  return named == ids;
}

void check_light_bulbs(const VectorMap& map, Report& report, const Relation& regulation) {
  const auto lights = map.lines(regulation, "refers"), bulbs = map.lines(regulation, "light_bulbs");
  for (const Way* line : bulbs) {
    if (has_tag(*line, "traffic_light_id")) continue;
    add_issue(report, map, 5, *line,
              fmt::format("is among the light_bulbs of traffic light {} and has no "
                          "traffic_light_id; add the id of the light's line",
                          regulation.id));
  }
  if (lights.size() != bulbs.size()) {
    add_issue(report, map, 6, regulation,
              fmt::format("has {} lights as \"refers\" and {} light_bulbs; give each light its "
                          "bulbs",
                          lights.size(), bulbs.size()));
  } else if (!belong_together(lights, bulbs)) {
    add_issue(report, map, 7, regulation,
              "its light_bulbs do not name its lights one by one; correct their traffic_light_id");
  }
}

void light_details(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Relation* regulation : map.regulations()) {
    if (regulation->subtype != "traffic_light") continue;
    if (map.lines(*regulation, "ref_line").empty() &&
        !is_for_pedestrians(map.lines(*regulation, "refers")) &&
        !is_for_crosswalks(map, *regulation)) {
      add_issue(report, map, 1, *regulation,
                "has no ref_line; add the line at which vehicles stop");
    }
    check_line_types(map, report, 2, *regulation, "refers", "traffic_light");
    check_line_types(map, report, 3, *regulation, "ref_line", "stop_line");
    check_line_types(map, report, 4, *regulation, "light_bulbs", "light_bulbs");
    check_light_bulbs(map, report, *regulation);
    check_extent(map, report, 8, *regulation, validation::Severity::warning);
  }
}

constexpr std::array<Rule, 6> kTrafficLightRules = {{
    {{"autoware.traffic-light.missing-regulation",
      {},
      validation::Severity::error,
      "no regulatory element refers to a traffic light",
      "TrafficLight.MissingRegulatoryElements"},
     unregulated_lights},
    {{"autoware.traffic-light.missing-referrers",
      {},
      validation::Severity::error,
      "no lanelet names a traffic light's regulatory element",
      "TrafficLight.MissingReferrers"},
     missing_referrers},
    {{"autoware.traffic-light.body-height",
      {},
      validation::Severity::error,
      "a traffic light's height is missing, or not between 0.2 and 2 m",
      "TrafficLight.BodyHeight"},
     body_heights},
    {{"autoware.traffic-light.light-bulbs",
      {},
      validation::Severity::error,
      "a light bulb has no color, or a color or an arrow that is not known",
      "TrafficLight.LightBulbTagging"},
     light_bulbs},
    {{"autoware.traffic-light.regulation-details",
      {},
      validation::Severity::error,
      "a traffic light's regulatory element names the wrong lights, bulbs or stop lines",
      "TrafficLight.RegulatoryElementDetails"},
     light_details},
    {{"autoware.traffic-light.facing",
      {},
      validation::Severity::error,
      "a traffic light faces away from the lanelets that name it",
      "TrafficLight.CorrectFacing"},
     light_facing},
}};

}  // namespace

std::span<const Rule> traffic_light_rules() { return kTrafficLightRules; }

}  // namespace roadbed::map::lanelet2::autoware
