#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "roadbed/map/lanelet2/autoware/rules.h"
#include "roadbed/map/lanelet2/autoware/shapes.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using validation::Report;
using validation::ValidateOptions;

constexpr std::string_view kTag = "intersection_area";
constexpr double kCovered = 0.99;  // share of a lanelet from which on it lies in an area

/// The area that a lanelet's tag names; null if it names none that is one.
const Way* tagged_area(const VectorMap& map, const Lanelet& lanelet) {
  const std::optional<std::int64_t> id = id_in(lanelet.tag(kTag));
  const Way* way = id ? map.way(*id) : nullptr;
  return way != nullptr && way->type == kTag && is_area(*way) ? way : nullptr;
}

bool is_intersection_area(const Way& way) { return way.type == kTag && is_area(way); }

void dangling_references(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Lanelet& lanelet : map.lanelets()) {
    if (!has_tag(lanelet, kTag) || tagged_area(map, lanelet) != nullptr) continue;
    add_issue(report, map, 1, lanelet,
              fmt::format("intersection_area={} names no area of type intersection_area in the "
                          "file, at which Autoware stops; correct the tag",
                          lanelet.tag(kTag)));
  }
}

/// Nodes that may be corners of an intersection area: of road borders, and of the ends of roads.
std::set<std::uint32_t> allowed_corners(const VectorMap& map) {
  std::set<std::uint32_t> allowed;
  for (const Way& way : map.document().ways) {
    if (way.type == "road_border") allowed.insert(way.nodes.begin(), way.nodes.end());
  }
  for (const Lanelet& lanelet : map.lanelets()) {
    if (lanelet.subtype() != "road" || !lanelet.text->start) continue;
    for (const auto& [left, right] : {*lanelet.text->start, *lanelet.text->end}) {
      allowed.insert(left);
      allowed.insert(right);
    }
  }
  return allowed;
}

void segment_types(const VectorMap& map, const ValidateOptions&, Report& report) {
  const std::set<std::uint32_t> allowed = allowed_corners(map);
  for (const Way& way : map.document().ways) {
    if (!is_intersection_area(way)) continue;
    std::vector<std::int64_t> ids;
    for (const std::uint32_t node : way.nodes) {
      const bool again = &node != way.nodes.data() && node == way.nodes.front();
      if (!again && !allowed.contains(node)) ids.push_back(map.document().nodes[node].id);
    }
    if (ids.empty()) continue;
    add_issue(report, map, 1, way,
              fmt::format("its corners {} belong neither to a road_border nor to the end of a road "
                          "lanelet; build the area of those nodes",
                          ids_text(ids)));
  }
}

/// Roads that lie in an area and do not say so.
void check_lanelets_in(const VectorMap& map, Report& report, const Way& area) {
  const Line2 ring = plan_of(map, area);
  for (const Lanelet* lanelet : map.near(geometry::box_around(ring))) {
    if (lanelet->subtype() != "road") continue;
    const std::string_view tag = lanelet->tag(kTag);
    if (tag == std::to_string(area.id)) continue;
    if (covered_share(map, *lanelet->surface, ring) < kCovered) continue;
    if (tag.empty()) {
      add_issue(
          report, map, 1, *lanelet,
          fmt::format("lies in intersection area {}; add intersection_area={}", area.id, area.id));
    } else {
      add_issue(report, map, 2, *lanelet,
                fmt::format("lies in intersection area {} and has intersection_area={}; correct it",
                            area.id, tag));
    }
  }
}

void tagging(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Way& way : map.document().ways) {
    if (is_intersection_area(way)) check_lanelets_in(map, report, way);
  }
  for (const Lanelet& lanelet : map.lanelets()) {
    if (!has_tag(lanelet, kTag)) {
      if (lanelet.tag("turn_direction").empty()) continue;
      add_issue(report, map, 4, lanelet,
                fmt::format("has turn_direction={} and no intersection_area; add the area it turns "
                            "in, or remove the direction",
                            lanelet.tag("turn_direction")));
      continue;
    }
    const Way* area = tagged_area(map, lanelet);
    if (area == nullptr || !lanelet.surface || map.budget().is_spent()) continue;
    const double share = covered_share(map, *lanelet.surface, plan_of(map, *area));
    if (share >= kCovered) continue;
    add_issue(report, map, 3, lanelet,
              fmt::format("has intersection_area={} and only {:.0f} % of it lie in that area; "
                          "correct the tag or the area",
                          area->id, 100.0 * share));
  }
}

void validity(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Way& way : map.document().ways) {
    if (!is_intersection_area(way)) continue;
    const auto fault = region_fault(map, way);
    if (!fault) continue;
    add_issue(report, map, 1, way, fmt::format("encloses no region: {}; redraw it", *fault));
  }
}

void lanelet_division(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Lanelet& lanelet : map.lanelets()) {
    const std::string_view area = lanelet.tag(kTag);
    if (area.empty()) continue;
    for (const Lanelet* next : map.following(lanelet)) {
      if (next->tag(kTag) != area) continue;
      add_issue(report, map, 1, lanelet,
                fmt::format("and the lanelet {} behind it are both in intersection area {}; make "
                            "them one",
                            next->id(), area));
    }
  }
}

bool is_fit_border(const Way* way) { return way->type == "virtual" || way->type == "road_border"; }

void border_types(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Lanelet& lanelet : map.lanelets()) {
    if (!has_tag(lanelet, kTag)) continue;
    for (const std::string_view side : {"left", "right"}) {
      const auto borders = map.lines(lanelet.relation(), side);
      const auto wrong = std::ranges::find_if_not(borders, is_fit_border);
      if (wrong == borders.end()) continue;
      add_issue(report, map, 1, lanelet,
                fmt::format("lies in an intersection and its {} border {} is of type \"{}\"; make "
                            "it virtual or road_border",
                            side, (*wrong)->id, (*wrong)->type));
      break;
    }
  }
}

constexpr std::array<Rule, 6> kIntersectionAreaRules = {{
    {{"autoware.intersection.dangling-area",
      {},
      validation::Severity::error,
      "a lanelet's intersection_area names no such area",
      "Intersection.IntersectionAreaDanglingReference"},
     dangling_references},
    {{"autoware.intersection.area-corners",
      {},
      validation::Severity::error,
      "an intersection area has corners that belong to no road border and no end of a road",
      "Intersection.IntersectionAreaSegmentType"},
     segment_types},
    {{"autoware.intersection.area-tag",
      {},
      validation::Severity::error,
      "a lanelet's intersection_area is not the area that it lies in",
      "Intersection.IntersectionAreaTagging"},
     tagging},
    {{"autoware.intersection.area-shape",
      {},
      validation::Severity::error,
      "an intersection area encloses no region",
      "Intersection.IntersectionAreaValidity"},
     validity},
    {{"autoware.intersection.lanelet-division",
      {},
      validation::Severity::error,
      "a way through an intersection is divided into several lanelets",
      "Intersection.LaneletDivision"},
     lanelet_division},
    {{"autoware.intersection.border-type",
      {},
      validation::Severity::error,
      "a lanelet in an intersection has borders that are neither virtual nor a road border",
      "Intersection.VirtualBorderType"},
     border_types},
}};

}  // namespace

std::span<const Rule> intersection_area_rules() { return kIntersectionAreaRules; }

}  // namespace roadbed::map::lanelet2::autoware
