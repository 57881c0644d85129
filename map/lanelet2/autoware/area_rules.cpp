#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/lanelet2/autoware/rules.h"
#include "roadbed/map/lanelet2/autoware/shapes.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using validation::Report;
using validation::ValidateOptions;

/// Ids of the areas that regulatory elements of a subtype refer to.
std::set<std::int64_t> areas_referred_to(const VectorMap& map, std::string_view subtype) {
  std::set<std::int64_t> ids;
  for (const Relation* regulation : map.regulations()) {
    if (regulation->subtype != subtype) continue;
    for (const Way* area : map.areas(*regulation, "refers")) ids.insert(area->id);
  }
  return ids;
}

/// Areas of a type that no regulatory element of that subtype refers to.
void areas_without_regulation(const VectorMap& map, Report& report, std::string_view type) {
  const std::set<std::int64_t> referred = areas_referred_to(map, type);
  for (const Way& way : map.document().ways) {
    if (way.type != type || !is_area(way) || referred.contains(way.id)) continue;
    add_issue(report, map, 1, way,
              fmt::format("no {} regulatory element refers to this area, so that it has no effect; "
                          "add one, or remove the area",
                          type));
  }
}

/// The one area of its type that a regulatory element refers to; says why there is none.
/// @param number  of the issue of a wrong count; that of a wrong type follows it.
const Way* only_area(const VectorMap& map, Report& report, const Relation& regulation, int number) {
  const auto areas = map.areas(regulation, "refers");
  if (areas.size() != 1) {
    add_issue(report, map, number, regulation,
              fmt::format("refers to {} areas, it needs just one; give each area an element of "
                          "its own",
                          areas.size()));
    return nullptr;
  }
  if (areas.front()->type == regulation.subtype) return areas.front();
  add_issue(report, map, number + 1, regulation,
            fmt::format("refers to way {} of type \"{}\"; refer to an area of type {}",
                        areas.front()->id, areas.front()->type, regulation.subtype));
  return nullptr;
}

/// Whether roads refer to a regulatory element, and nothing else does.
/// @param number  of the issue of no referrer; that of a wrong one follows it.
void check_referrers(const VectorMap& map, Report& report, const Relation& regulation, int number) {
  const auto users = map.users(regulation);
  if (users.empty()) {
    add_issue(report, map, number, regulation,
              "no lanelet names it; add it to the lanelets of subtype road that it holds for");
  }
  for (const Lanelet* user : users) {
    if (user->subtype() == "road") continue;
    add_issue(report, map, number + 1, regulation,
              fmt::format("lanelet {} of subtype \"{}\" names it, only those of subtype road may; "
                          "remove it there",
                          user->id(), user->subtype()));
    return;
  }
}

void detection_areas(const VectorMap& map, const ValidateOptions&, Report& report) {
  areas_without_regulation(map, report, "detection_area");
  for (const Relation* regulation : map.regulations()) {
    if (regulation->subtype != "detection_area") continue;
    if (only_area(map, report, *regulation, 2) == nullptr) continue;
    const auto lines = map.lines(*regulation, "ref_line");
    if (lines.size() != 1 || lines.front()->type != "stop_line") {
      add_issue(report, map, 4, *regulation,
                fmt::format("has {} ref_lines{}; it needs just one, of type stop_line",
                            lines.size(), lines.size() == 1 ? " of another type" : ""));
      continue;
    }
    check_referrers(map, report, *regulation, 5);
  }
}

/// Whether a no_stopping_area has one stop line or none; says what is wrong.
bool has_fit_stop_line(const VectorMap& map, Report& report, const Relation& regulation) {
  const auto lines = map.lines(regulation, "ref_line");
  if (lines.size() > 1) {
    add_issue(report, map, 4, regulation,
              fmt::format("has {} ref_lines, it may have one; split the element", lines.size()));
    return false;
  }
  if (lines.empty() || lines.front()->type == "stop_line") return true;
  add_issue(report, map, 5, regulation,
            fmt::format("its ref_line {} is of type \"{}\"; refer to one of type stop_line",
                        lines.front()->id, lines.front()->type));
  return false;
}

void no_stopping_areas(const VectorMap& map, const ValidateOptions&, Report& report) {
  areas_without_regulation(map, report, "no_stopping_area");
  for (const Relation* regulation : map.regulations()) {
    if (regulation->subtype != "no_stopping_area") continue;
    if (only_area(map, report, *regulation, 2) == nullptr) continue;
    if (has_fit_stop_line(map, report, *regulation)) check_referrers(map, report, *regulation, 6);
  }
}

void bus_stop_areas(const VectorMap& map, const ValidateOptions&, Report& report) {
  areas_without_regulation(map, report, "bus_stop_area");
}

/// Corners of an area that no lanelet near it has in its borders.
std::vector<std::int64_t> unshared_corners(const VectorMap& map, const Way& area,
                                           const std::vector<const Lanelet*>& near) {
  const Document& document = map.document();
  std::set<std::uint32_t> shared;
  for (const Lanelet* lanelet : near) {
    for (const Border border : {lanelet->surface->left_border, lanelet->surface->right_border}) {
      const auto nodes = document.ways[border.way].nodes;
      map.budget().spend(nodes.size());
      shared.insert(nodes.begin(), nodes.end());
    }
  }
  std::vector<std::int64_t> ids;
  for (const std::uint32_t node : area.nodes) {
    const bool again = &node != area.nodes.data() && node == area.nodes.front();
    if (!again && !shared.contains(node)) ids.push_back(document.nodes[node].id);
  }
  return ids;
}

/// Whether a lanelet runs across the area: it comes in and goes out beside the road that the area
/// lies on, as one from a side street does, which is painted over.
bool comes_from_the_side(const VectorMap& map, const Lanelet& lanelet, const Way& area) {
  const std::set<std::uint32_t> corners(area.nodes.begin(), area.nodes.end());
  const Document& document = map.document();
  map.budget().spend(lanelet.surface->ring.size());
  for (const Border border : {lanelet.surface->left_border, lanelet.surface->right_border}) {
    for (const std::uint32_t node : document.ways[border.way].nodes) {
      if (corners.contains(node)) return false;
    }
  }
  return true;
}

void buffer_zones(const VectorMap& map, const ValidateOptions&, Report& report) {
  constexpr double kLeastShare = 0.01;  // of the zone that a lanelet may cover
  for (const Way& way : map.document().ways) {
    if (way.type != "hatched_road_markings" || !is_area(way)) continue;
    const Line2 ring = plan_of(map, way);
    const auto near = map.near(geometry::box_around(ring));
    const std::vector<std::int64_t> unshared = unshared_corners(map, way, near);
    if (map.budget().is_spent()) return;
    if (!unshared.empty()) {
      add_issue(report, map, 1, way,
                fmt::format("its corners {} belong to no border of a lanelet near it; build the "
                            "area of the borders' nodes",
                            ids_text(unshared)));
    }
    if (const auto fault = region_fault(map, way)) {
      add_issue(report, map, 2, way, fmt::format("encloses no region: {}; redraw it", *fault));
      continue;
    }
    const double area_m2 = std::abs(geometry::signed_area_m2(ring));
    for (const Lanelet* lanelet : near) {
      const bool is_road = lanelet->subtype() == "road";
      if (!is_road && lanelet->subtype() != "road_shoulder") continue;
      const double share = overlap_m2(map, ring, lanelet->surface->ring) / area_m2;
      if (!(share > kLeastShare)) continue;
      if (is_road && comes_from_the_side(map, *lanelet, way)) continue;
      add_issue(report, map, 3, way,
                fmt::format("{:.0f} % of it lie on lanelet {} of subtype {}, where vehicles drive; "
                            "draw it beside the lanelet",
                            100.0 * share, lanelet->id(), lanelet->subtype()))
          .severity = validation::Severity::warning;
    }
  }
}

constexpr std::array<Rule, 4> kAreaRules = {{
    {{"autoware.area.detection-area",
      {},
      validation::Severity::error,
      "a detection area and its regulatory element, stop line and lanelets do not fit",
      "Area.DetectionArea"},
     detection_areas},
    {{"autoware.area.no-stopping-area",
      {},
      validation::Severity::error,
      "a no-stopping area and its regulatory element, stop line and lanelets do not fit",
      "Area.NoStoppingArea"},
     no_stopping_areas},
    {{"autoware.area.missing-regulation-of-bus-stop",
      {},
      validation::Severity::error,
      "no regulatory element refers to a bus stop area",
      "Area.MissingRegulatoryElementsForBusStopAreas"},
     bus_stop_areas},
    {{"autoware.area.buffer-zone",
      {},
      validation::Severity::error,
      "hatched markings do not share nodes with borders, enclose nothing, or lie on a lanelet",
      "Area.BufferZoneValidity"},
     buffer_zones},
}};

}  // namespace

std::span<const Rule> area_rules() { return kAreaRules; }

}  // namespace roadbed::map::lanelet2::autoware
