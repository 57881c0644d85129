#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/lanelet2/autoware/regulation_members.h"
#include "roadbed/map/lanelet2/autoware/virtual_lights.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using validation::Report;
using validation::ValidateOptions;
using LaneletWay = std::vector<const Lanelet*>;

/// A light without just one start line, or without end line, at which Autoware refuses the map: no
/// issue of its validator, which then does not come so far.
void check_counts(const VectorMap& map, Report& report, const Relation& light) {
  const std::size_t starts = map.lines(light, "start_line").size();
  const std::size_t ends = map.lines(light, "end_line").size();
  if (starts == 1 && ends > 0) return;
  validation::Finding& finding = rules::add_at(
      report, map.source(), light,
      fmt::format(
          "has {} start_lines and {} end_lines, and Autoware does not read a map with such a "
          "virtual traffic light; give it one start_line, and an end_line for each lanelet",
          starts, ends));
  finding.in_map = map.place(light);
}

void virtual_light_details(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Relation* light : map.regulations()) {
    if (light->subtype != "virtual_traffic_light") continue;
    check_counts(map, report, *light);
    check_line_types(map, report, 1, *light, "start_line", "virtual");
    const std::size_t stops = map.lines(*light, "ref_line").size();
    if (stops != 1) {
      add_issue(report, map, 2, *light,
                fmt::format("has {} ref_lines; it needs just one, its stop line", stops));
    }
    check_line_types(map, report, 3, *light, "ref_line", "stop_line");
    check_line_types(map, report, 4, *light, "end_line", "virtual");
    if (map.lines(*light, "refers").empty()) {
      add_issue(report, map, 5, *light,
                "refers to nothing; add a line of type intersection_coordination as member "
                "\"refers\"");
    }
    check_line_types(map, report, 6, *light, "refers", "intersection_coordination");
    check_extent(map, report, 7, *light, validation::Severity::error);
  }
}

/// The stretch of a virtual traffic light that ends on one of the lanelets that name it.
struct Stretch {
  const Relation* light = nullptr;
  const Way *start_line = nullptr, *end_line = nullptr;
  LaneletWay way;  ///< from the start line's lanelet to the end line's
};

geometry::Ring ring_of(const LaneletWay& way) {
  geometry::Ring ring;
  for (const Lanelet* lanelet : way) {
    for (const auto& point : lanelet->surface->left) ring.emplace_back(point.head<2>());
  }
  for (auto lanelet = way.rbegin(); lanelet != way.rend(); ++lanelet) {
    const auto& right = (*lanelet)->surface->right;
    for (auto point = right.rbegin(); point != right.rend(); ++point) {
      ring.emplace_back(point->head<2>());
    }
  }
  return ring;
}

/// Whether the stop line lies on the stretch, and between its start and its end.
void check_order(const VectorMap& map, Report& report, const Stretch& stretch,
                 const Way& stop_line) {
  constexpr double kLeastShare = 0.1;  // of the stop line
  if (share_inside(map, plan_of(map, stop_line), ring_of(stretch.way)) < kLeastShare) {
    add_issue(
        report, map, 5, stop_line,
        fmt::format("is the stop line of virtual traffic light {} and does not lie on the way "
                    "from its start_line to its end_line {}; move it there",
                    stretch.light->id, stretch.end_line->id));
  }
  const CrossingStations start = stations_of(map, *stretch.start_line, stretch.way);
  const CrossingStations stop = stations_of(map, stop_line, stretch.way);
  const CrossingStations end = stations_of(map, *stretch.end_line, stretch.way);
  if (is_before(start, stop) && is_before(stop, end)) return;
  add_issue(report, map, 6, *stretch.light,
            fmt::format("its start_line {}, stop line {} and end_line {} do not follow each other "
                        "in driving direction; move or swap them",
                        stretch.start_line->id, stop_line.id, stretch.end_line->id));
}

/// The end lines of a light, each with the lanelet that names the light and that it lies on; issues
/// about lanelets that have none.
std::vector<std::pair<const Way*, const Lanelet*>> end_lines(const VectorMap& map, Report& report,
                                                             const Relation& light) {
  std::vector<std::pair<const Way*, const Lanelet*>> found;
  for (const Lanelet* user : map.users(light)) {
    if (!user->surface) continue;
    if (const Way* line = end_line_on(map, light, *user)) {
      found.emplace_back(line, user);
      continue;
    }
    if (map.budget().is_spent()) break;
    add_issue(report, map, 2, light,
              fmt::format("lanelet {} names it and none of its end_lines lies on the lanelet; add "
                          "or move one",
                          user->id()));
  }
  return found;
}

void check_light(const VectorMap& map, Report& report, const Relation& light) {
  const auto starts = map.lines(light, "start_line"), stops = map.lines(light, "ref_line");
  if (starts.empty() || stops.empty() || starts.front()->nodes.size() < 2 ||
      stops.front()->nodes.size() < 2) {
    return;  // virtual_light_details() says so, or its nodes have no place
  }
  const Way& start = *starts.front();
  const Lanelet* from = lanelet_under(map, start);
  if (map.budget().is_spent()) return;
  if (from == nullptr) {
    add_issue(report, map, 1, start,
              fmt::format("is the start_line of virtual traffic light {} and lies on no lanelet; "
                          "move it onto one",
                          light.id));
    return;
  }
  const auto ends = end_lines(map, report, light);
  const Line2 plan = plan_of(map, start);
  for (const auto& [line, user] : ends) {
    if (!touch(map, plan, user->surface->ring)) continue;
    add_issue(
        report, map, 3, start,
        fmt::format("is the start_line of virtual traffic light {} and meets lanelet {}, which "
                    "names the light; move it before the lanelet",
                    light.id, user->id()));
    return;
  }
  for (const auto& [line, user] : ends) {
    const Stretch stretch{&light, &start, line, shortest_way(map, *from, *user)};
    if (map.budget().is_spent()) return;
    if (stretch.way.empty()) {
      add_issue(
          report, map, 4, light,
          fmt::format("no lanelets lead from its start_line {} to its end_line {}; move them, "
                      "or connect the lanelets",
                      start.id, line->id));
      continue;
    }
    check_order(map, report, stretch, *stops.front());
  }
}

void line_order(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Relation* light : map.regulations()) {
    if (light->subtype != "virtual_traffic_light" || !coordinates_intersection(map, *light)) {
      continue;
    }
    check_light(map, report, *light);
  }
}

/// Every stretch of every light that is whole.
std::vector<Stretch> stretches(const VectorMap& map) {
  std::vector<Stretch> found;
  for (const Relation* light : map.regulations()) {
    if (light->subtype != "virtual_traffic_light" || !coordinates_intersection(map, *light)) {
      continue;
    }
    const auto starts = map.lines(*light, "start_line");
    const Lanelet* from = starts.empty() ? nullptr : lanelet_under(map, *starts.front());
    if (from == nullptr) continue;
    for (const Lanelet* user : map.users(*light)) {
      const Way* end = user->surface ? end_line_on(map, *light, *user) : nullptr;
      if (end == nullptr) continue;
      Stretch stretch{light, starts.front(), end, shortest_way(map, *from, *user)};
      if (!stretch.way.empty()) found.push_back(std::move(stretch));
    }
  }
  return found;
}

/// Whether `other` begins on the way of `stretch`, before the end line, and goes on as it does:
/// ways that part are not compared, as both lights may then hold for different directions.
bool begins_on(const VectorMap& map, const Stretch& other, const Stretch& stretch) {
  const auto at = std::ranges::find(stretch.way, other.way.front());
  if (at == stretch.way.end()) return false;
  const auto [one, two] = std::mismatch(at, stretch.way.end(), other.way.begin(), other.way.end());
  if (one != stretch.way.end() && two != other.way.end()) return false;
  return !is_before(stations_of(map, *stretch.end_line, stretch.way),
                    stations_of(map, *other.start_line, stretch.way));
}

void section_overlap(const VectorMap& map, const ValidateOptions&, Report& report) {
  const std::vector<Stretch> all = stretches(map);
  std::map<const Lanelet*, std::vector<const Stretch*>> beginning_on;
  for (const Stretch& stretch : all) beginning_on[stretch.way.front()].push_back(&stretch);
  std::set<std::pair<const Relation*, const Relation*>> said;
  for (const Stretch& stretch : all) {
    for (const Lanelet* lanelet : stretch.way) {
      const auto others = beginning_on.find(lanelet);
      if (others == beginning_on.end()) continue;
      for (const Stretch* other : others->second) {
        if (other->light == stretch.light || said.contains({stretch.light, other->light}) ||
            !map.budget().spend(100) || !begins_on(map, *other, stretch)) {
          continue;
        }
        said.emplace(stretch.light, other->light);
        add_issue(report, map, 1, *other->light,
                  fmt::format("begins at start_line {} where the stretch of {} is not over, which "
                              "ends at end_line {}; move the lines apart",
                              other->start_line->id, stretch.light->id, stretch.end_line->id));
      }
    }
  }
}

constexpr std::array<Rule, 3> kVirtualLightRules = {{
    {{"autoware.intersection.virtual-light-details",
      {},
      validation::Severity::error,
      "a virtual traffic light names lines of wrong number or type",
      "Intersection.RegulatoryElementDetailsForVirtualTrafficLights"},
     virtual_light_details},
    {{"autoware.intersection.virtual-light-order",
      {},
      validation::Severity::error,
      "start, stop and end line of a virtual traffic light do not follow each other on lanelets",
      "Intersection.VirtualTrafficLightLineOrder"},
     line_order},
    {{"autoware.intersection.virtual-light-overlap",
      {},
      validation::Severity::error,
      "a virtual traffic light begins before another one ends",
      "Intersection.VirtualTrafficLightSectionOverlap"},
     section_overlap},
}};

}  // namespace

std::span<const Rule> virtual_light_rules() { return kVirtualLightRules; }

}  // namespace roadbed::map::lanelet2::autoware
