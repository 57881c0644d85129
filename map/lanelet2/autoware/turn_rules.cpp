#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <queue>
#include <set>
#include <utility>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/lanelet2/autoware/rules.h"
#include "roadbed/map/lanelet2/autoware/shapes.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using validation::Report;
using validation::ValidateOptions;

bool lies_in(const VectorMap& map, const Lanelet& lanelet, const geometry::Ring& ring) {
  const geometry::Ring& own = lanelet.surface->ring;
  if (!map.budget().spend(own.size() * ring.size())) return false;
  return std::ranges::all_of(own,
                             [&](const auto& point) { return geometry::contains(ring, point); });
}

void check_direction(const VectorMap& map, Report& report, const Lanelet& lanelet) {
  const std::string_view direction = lanelet.tag("turn_direction");
  if (direction.empty()) {
    add_issue(report, map, 1, lanelet,
              "lies in an intersection and has no turn_direction; add straight, left or right");
  } else if (direction != "straight" && direction != "left" && direction != "right") {
    add_issue(report, map, 2, lanelet,
              fmt::format("turn_direction is \"{}\"; make it straight, left or right", direction));
  }
}

void direction_tags(const VectorMap& map, const ValidateOptions&, Report& report) {
  std::set<const Lanelet*> looked_at;
  for (const Way& way : map.document().ways) {
    if (way.type != "intersection_area" || !is_area(way)) continue;
    const Line2 ring = plan_of(map, way);
    for (const Lanelet* lanelet : map.near(geometry::box_around(ring))) {
      if (lanelet->subtype() != "road" || !lies_in(map, *lanelet, ring)) continue;
      if (looked_at.insert(lanelet).second) check_direction(map, report, *lanelet);
    }
  }
}

bool is_opposite(std::string_view one, std::string_view other) {
  return (one == "left" && other == "right") || (one == "right" && other == "left");
}

/// Lanelets that turn the other way and lie wholly within a distance before this one; at most the
/// nearest thousand are looked at.
std::vector<std::int64_t> opposite_turns_before(const VectorMap& map, const Lanelet& lanelet,
                                                double within_m) {
  constexpr std::size_t kMost = 1000;
  using Reached = std::pair<double, const Lanelet*>;  // how far before this one it begins
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> ahead;
  ahead.emplace(0.0, &lanelet);
  std::set<const Lanelet*> seen;
  std::vector<std::int64_t> found;
  while (!ahead.empty() && ahead.top().first <= within_m && seen.size() < kMost) {
    const auto [begins_m, at] = ahead.top();
    ahead.pop();
    if (!seen.insert(at).second || !map.budget().spend(at->surface->ring.size())) continue;
    if (is_opposite(lanelet.tag("turn_direction"), at->tag("turn_direction"))) {
      found.push_back(at->id());
    }
    for (const Lanelet* before : map.previous(*at)) {
      if (!is_for_vehicles(*before) || seen.contains(before)) continue;
      ahead.emplace(begins_m + way_length_m(*before->surface), before);
    }
  }
  std::ranges::sort(found);
  return found;
}

void signal_distances(const VectorMap& map, const ValidateOptions&, Report& report) {
  constexpr double kUsual_m = 15.0;  // Autoware's, where the lanelet has none
  for (const Lanelet& lanelet : map.lanelets()) {
    const std::string_view direction = lanelet.tag("turn_direction");
    if (!lanelet.surface || (direction != "left" && direction != "right")) continue;
    const double tagged_m = number_in(lanelet.tag("turn_signal_distance"));
    const double within_m = tagged_m >= 0.0 ? tagged_m : kUsual_m;
    const auto before = opposite_turns_before(map, lanelet, within_m);
    if (before.empty()) continue;
    add_issue(
        report, map, 1, lanelet,
        fmt::format("its turn signal begins {:.1f} m before it, so that lanelets {}, which turn "
                    "the other way, are passed with it; set turn_signal_distance to less",
                    within_m, ids_text(before)));
  }
}

constexpr std::array<Rule, 2> kTurnRules = {{
    {{"autoware.intersection.turn-direction",
      {},
      validation::Severity::error,
      "a lanelet in an intersection has no turn_direction, or one that is not known",
      "Intersection.TurnDirectionTagging"},
     direction_tags},
    {{"autoware.intersection.turn-signal-distance",
      {},
      validation::Severity::error,
      "a turn signal begins before a lanelet that turns the other way",
      "Intersection.TurnSignalDistanceOverlap"},
     signal_distances},
}};

}  // namespace

std::span<const Rule> turn_rules() { return kTurnRules; }

}  // namespace roadbed::map::lanelet2::autoware
