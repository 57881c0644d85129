#include <fmt/format.h>

#include <array>
#include <set>

#include "roadbed/map/lanelet2/autoware/regulation_members.h"
#include "roadbed/map/lanelet2/autoware/rules.h"
#include "roadbed/map/lanelet2/autoware/shapes.h"
#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using validation::Report;
using validation::ValidateOptions;

void unregulated_crosswalks(const VectorMap& map, const ValidateOptions&, Report& report) {
  std::set<const Lanelet*> referred;
  for (const Relation* regulation : map.regulations()) {
    if (regulation->subtype != "crosswalk") continue;
    for (const Lanelet* lanelet : map.lanelets(*regulation, "refers")) referred.insert(lanelet);
  }
  for (const Lanelet& lanelet : map.lanelets()) {
    if (lanelet.subtype() != "crosswalk" || referred.contains(&lanelet)) continue;
    add_issue(report, map, 1, lanelet,
              "no crosswalk regulatory element refers to this crosswalk, so that nobody stops for "
              "it; add one");
  }
}

/// Its crosswalks: how many they are.
void check_count(const VectorMap& map, Report& report, const Relation& regulation) {
  const std::size_t count = map.lanelets(regulation, "refers").size();
  if (count == 0) {
    add_issue(report, map, 1, regulation,
              "refers to no crosswalk; add the lanelet as member \"refers\"");
  } else if (count > 1) {
    add_issue(report, map, 2, regulation,
              fmt::format("refers to {} crosswalks; give each an element of its own", count));
  }
}

void check_stop_lines(const VectorMap& map, Report& report, const Relation& regulation) {
  const auto lines = map.lines(regulation, "ref_line");
  if (lines.empty()) {
    add_issue(report, map, 3, regulation,
              "has no ref_line, so that vehicles stop at a distance of their own; add the stop "
              "line if there is one")
        .severity = validation::Severity::info;
  } else if (lines.size() > 1) {
    add_issue(
        report, map, 9, regulation,
        fmt::format("has {} ref_lines; give each stop line an element of its own", lines.size()));
  }
  for (const Way* line : lines) {
    if (line->type == "stop_line") continue;
    add_issue(report, map, 7, *line,
              fmt::format("is the ref_line of crosswalk element {} and of type \"{}\"; make it "
                          "stop_line",
                          regulation.id, line->type));
  }
}

/// Whether the crosswalk is one, for pedestrians, and crosses the roads that name the element.
void check_crosswalk(const VectorMap& map, Report& report, const Relation& regulation,
                     const Lanelet& crosswalk) {
  if (crosswalk.subtype() != "crosswalk") {
    add_issue(report, map, 6, crosswalk,
              fmt::format("crosswalk element {} refers to it and it is of subtype \"{}\"; make it "
                          "crosswalk, or refer to another lanelet",
                          regulation.id, crosswalk.subtype()));
  }
  const std::string_view pedestrians = crosswalk.tag("participant:pedestrian");
  if (pedestrians.empty()) {
    add_issue(report, map, 10, crosswalk, "does not admit pedestrians; add participant:pedestrian");
  } else if (!truth_of(pedestrians).value_or(false)) {
    add_issue(report, map, 11, crosswalk,
              fmt::format("participant:pedestrian is \"{}\"; make it yes", pedestrians));
  }
  if (!crosswalk.surface) return;
  for (const Lanelet* user : map.users(regulation)) {
    if (user->subtype() != "road" || !user->surface) continue;
    if (!map.budget().spend(crosswalk.surface->ring.size() * user->surface->ring.size())) return;
    if (touch(map, crosswalk.surface->ring, user->surface->ring) ||
        touch(map, user->surface->ring, crosswalk.surface->ring)) {
      continue;
    }
    if (map.budget().is_spent()) return;
    add_issue(report, map, 12, regulation,
              fmt::format("road lanelet {} names it and does not meet its crosswalk {}; remove the "
                          "element from the lanelet",
                          user->id(), crosswalk.id()));
  }
}

/// What Autoware asked of a crosswalk's polygon until version 1.1.0 of its validator.
void check_polygons(const VectorMap& map, const ValidateOptions& options, Report& report,
                    const Relation& regulation) {
  const auto is_named = [&](int number) {
    return options.choice.names(report.autoware_issue(number));
  };
  const auto areas = map.areas(regulation, "crosswalk_polygon");
  if (areas.empty() && is_named(4)) {
    add_issue(report, map, 4, regulation, "has no crosswalk_polygon; add one").severity =
        validation::Severity::warning;
  }
  if (areas.size() > 1 && is_named(5)) {
    add_issue(report, map, 5, regulation,
              fmt::format("has {} crosswalk_polygons; keep one", areas.size()));
  }
  for (const Way* area : areas) {
    if (area->type == "crosswalk_polygon" || !is_named(8)) continue;
    add_issue(report, map, 8, *area,
              fmt::format("is the crosswalk_polygon of element {} and of type \"{}\"; make it "
                          "crosswalk_polygon",
                          regulation.id, area->type));
  }
}

void crosswalk_details(const VectorMap& map, const ValidateOptions& options, Report& report) {
  for (const Relation* regulation : map.regulations()) {
    if (regulation->subtype != "crosswalk") continue;
    check_count(map, report, *regulation);
    check_stop_lines(map, report, *regulation);
    for (const Lanelet* crosswalk : map.lanelets(*regulation, "refers")) {
      check_crosswalk(map, report, *regulation, *crosswalk);
    }
    check_polygons(map, options, report, *regulation);
    check_extent(map, report, 13, *regulation, validation::Severity::warning);
  }
}

void check_positive(const VectorMap& map, Report& report, int number, const Lanelet& crosswalk,
                    std::string_view key) {
  const std::string_view value = crosswalk.tag(key);
  if (!has_tag(crosswalk, key) || number_in(value) > 0.0) return;
  add_issue(report, map, number, crosswalk,
            fmt::format("{} is \"{}\", no positive number; correct it", key, value));
}

void safety_attributes(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Lanelet& lanelet : map.lanelets()) {
    if (lanelet.subtype() != "crosswalk") continue;
    check_positive(map, report, 1, lanelet, "safety_slow_down_speed");
    check_positive(map, report, 2, lanelet, "safety_slow_down_distance");
  }
}

constexpr std::array<Rule, 3> kCrosswalkRules = {{
    {{"autoware.crosswalk.missing-regulation",
      {},
      validation::Severity::error,
      "no regulatory element refers to a crosswalk",
      "Crosswalk.MissingRegulatoryElements"},
     unregulated_crosswalks},
    {{"autoware.crosswalk.regulation-details",
      {},
      validation::Severity::error,
      "a crosswalk's regulatory element names the wrong crosswalks, roads or stop lines",
      "Crosswalk.RegulatoryElementDetails"},
     crosswalk_details},
    {{"autoware.crosswalk.safety-attributes",
      {},
      validation::Severity::error,
      "a crosswalk's safety_slow_down_speed or _distance is no positive number",
      "Crosswalk.SafetyAttributes"},
     safety_attributes},
}};

}  // namespace

std::span<const Rule> crosswalk_rules() { return kCrosswalkRules; }

}  // namespace roadbed::map::lanelet2::autoware
