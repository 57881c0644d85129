#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "roadbed/map/derived/components.h"
#include "roadbed/map/elements/outside_links.h"
#include "roadbed/map/validation/validate.h"

namespace roadbed::map::validation {
namespace {

constexpr double kNone_m = 1e-3;  // of width

bool holds(const std::vector<LaneId>& lanes, LaneId lane) {
  return std::find(lanes.begin(), lanes.end(), lane) != lanes.end();
}

void add_one_sided(const RoadMap& road_map, const Lane& lane, LaneId other, const char* relation,
                   const char* back, Report& report) {
  Finding& finding = report.add(
      "lane " + lane.name, lane.pose_at(0.5 * lane.length_m()).position(),
      fmt::format("has lane {} as {}, which does not have it as {}; add the missing link or remove "
                  "this one",
                  road_map.lane(other).name, relation, back));
  if (!is_drivable(lane.type)) finding.severity = Severity::warning;
}

void one_sided_links(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  const LaneGraph& graph = road_map.graph();
  for (const Lane& lane : road_map.lanes()) {
    for (const LaneId to : graph.of(lane.id).successors) {
      if (holds(graph.of(to).predecessors, lane.id)) continue;
      add_one_sided(road_map, lane, to, "successor", "predecessor", report);
    }
    for (const LaneId from : graph.of(lane.id).predecessors) {
      if (holds(graph.of(from).successors, lane.id)) continue;
      add_one_sided(road_map, lane, from, "predecessor", "successor", report);
    }
  }
}

/// ASAM's rules name the end by the reference line of an OpenDRIVE road, which runs against some
/// lanes.
const char* end_along_road(const Lane& lane, bool at_end) {
  const bool against = lane.origin.road_from_s_m > lane.origin.road_to_s_m;
  return at_end == against ? "start" : "end";
}

void add_zero_width(const Lane& lane, bool at_end, const Eigen::Vector2d& in_map, Report& report) {
  report
      .add("lane " + lane.name, in_map,
           fmt::format("has no width at its {} but a {} there; remove the link",
                       at_end ? "end" : "start", at_end ? "successor" : "predecessor"))
      .asam_rule = fmt::format("asam.net:xodr:1.7.0:road.lane.link.zero_width_at_{}",
                               end_along_road(lane, at_end));
}

void zero_width_links(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for (const Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type)) continue;
    const LaneLinks& links = road_map.graph().of(lane.id);
    const auto& centre = lane.centre.in_map.points();
    if (!links.predecessors.empty() && lane.width_m(0.0) < kNone_m) {
      add_zero_width(lane, false, centre.front(), report);
    }
    if (!links.successors.empty() && lane.width_m(lane.length_m()) < kNone_m) {
      add_zero_width(lane, true, centre.back(), report);
    }
  }
}

/// Whether a lane's links lead to what is not in the file, which is a part of a larger map, or a
/// clip has cut it (map/edit).
bool leads_outside(const Lane& lane, std::string_view key) {
  return std::ranges::any_of(lane.attributes, [&](const auto& entry) {
    return entry.first == key || entry.first == "roadbed:clip";
  });
}

void dead_ends(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for (const Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type) || !road_map.graph().of(lane.id).successors.empty() ||
        leads_outside(lane, kSuccessorsOutside) || lane.width_m(lane.length_m()) < kNone_m) {
      continue;
    }
    Finding& finding =
        report.add("lane " + lane.name, lane.centre.in_map.points().back(),
                   lane.junction ? "leads into its junction but not out; link its end to a lane"
                                 : "leads nowhere; link its end if the road goes on");
    if (lane.junction) finding.severity = Severity::warning;
  }
}

void unreachable_lanes(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for (const Lane& lane : road_map.lanes()) {
    const LaneLinks& links = road_map.graph().of(lane.id);
    if (!is_drivable(lane.type) || !links.predecessors.empty() ||
        leads_outside(lane, kPredecessorsOutside) || lane.width_m(0.0) < kNone_m) {
      continue;
    }
    const auto joins = [](const std::optional<Neighbour>& neighbour) {
      return neighbour && neighbour->same_direction;
    };
    if (!lane.junction && (joins(links.left) || joins(links.right))) continue;
    Finding& finding =
        report.add("lane " + lane.name, lane.centre.in_map.points().front(),
                   lane.junction ? "leads out of its junction, but nothing leads to it; link its "
                                   "start to a lane"
                                 : "nothing leads to it; link its start if the road comes from "
                                   "further on");
    if (lane.junction) finding.severity = Severity::warning;
  }
}

void lanes_off_the_road(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for (const Lane& lane : road_map.lanes()) {
    const auto& successors = road_map.graph().of(lane.id).successors;
    const auto drivable = [&](LaneId to) { return is_drivable(road_map.lane(to).type); };
    if (!is_drivable(lane.type) || successors.empty() ||
        std::any_of(successors.begin(), successors.end(), drivable)) {
      continue;
    }
    const Lane& next = road_map.lane(successors.front());
    report.add("lane " + lane.name, lane.centre.in_map.points().back(),
               fmt::format("leads to lane {} of type {} only; check the types and the link",
                           next.name, to_string(next.type)));
  }
}

void self_links(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  for (const Lane& lane : road_map.lanes()) {
    if (!holds(road_map.graph().of(lane.id).successors, lane.id)) continue;
    const auto& points = lane.centre.in_map.points();
    if ((points.front() - points.back()).norm() < 0.5) continue;  // a ring, as a roundabout
    report.add("lane " + lane.name, points.back(),
               "is its own successor although its ends do not meet; remove the link");
  }
}

/// Drivable lanes that links, lane changes, neighbours or a road join, the largest part first: a
/// road's two directions are one part, though nobody turns round on it.
std::vector<std::vector<LaneId>> parts_of(const RoadMap& road_map) {
  LaneGroups groups(road_map.lanes().size());
  std::vector<bool> counts(road_map.lanes().size());
  for (const Lane& lane : road_map.lanes()) counts[lane.id.index] = is_drivable(lane.type);
  const auto wanted = [&](LaneId lane) { return counts[lane.index]; };
  for (const Lane& lane : road_map.lanes()) {
    if (!wanted(lane.id)) continue;
    const LaneLinks& links = road_map.graph().of(lane.id);
    groups.join(lane.id, links, wanted);
    for (const auto* neighbour : {&links.left, &links.right}) {
      if (*neighbour && wanted((*neighbour)->lane)) groups.join(lane.id, (*neighbour)->lane);
    }
  }
  for (const Road& road : road_map.roads()) {
    const auto first = std::ranges::find_if(road.lanes, wanted);
    for (auto lane = first; lane != road.lanes.end(); ++lane) {
      if (wanted(*lane)) groups.join(*first, *lane);
    }
  }
  return groups.lists(counts);
}

void separate_parts(const RoadMap& road_map, const ValidateOptions&, Report& report) {
  const auto components = parts_of(road_map);
  for (std::size_t i = 1; i < components.size(); ++i) {
    const Lane& first = road_map.lane(components[i].front());
    report.add("lane " + first.name, first.pose_at(0.5 * first.length_m()).position(),
               fmt::format(
                   "{} that no link or neighbour joins to the largest part; add links if it should "
                   "be reached",
                   components[i].size() == 1
                       ? std::string("is one lane")
                       : fmt::format("begins a part of {} lanes", components[i].size())));
  }
}

constexpr std::array<MapRule, 7> kLinkRules = {{
    {{"link.one-sided", "asam.net:xodr:1.4.0:road.lane.link.lanes_across_lane_sections",
      Severity::error, "a lane's successor or predecessor does not know of it"},
     one_sided_links},
    {{"link.zero-width",
      {},
      Severity::warning,
      "a drivable lane is linked at an end where it has no width"},
     zero_width_links},
    {{"link.dead-end",
      {},
      Severity::info,
      "a drivable lane that has width to its end leads nowhere (a warning in a junction)"},
     dead_ends},
    {{"link.unreachable",
      {},
      Severity::info,
      "nothing leads to a drivable lane that has width from its start on (a warning in a "
      "junction)"},
     unreachable_lanes},
    {{"link.leads-off-road",
      {},
      Severity::info,
      "a drivable lane leads to lanes only that no car drives on"},
     lanes_off_the_road},
    {{"link.self", {}, Severity::warning, "a lane is its own successor"}, self_links},
    {{"link.separate-part",
      {},
      Severity::info,
      "no link, neighbour or road joins drivable lanes to the largest part"},
     separate_parts},
}};

}  // namespace

std::span<const MapRule> link_rules() { return kLinkRules; }

std::vector<MapRule> map_rules() {
  std::vector<MapRule> all;
  for (const auto rules : {continuity_rules(), border_rules(), link_rules(), neighbour_rules(),
                           surface_rules(), attribute_rules(), furniture_rules()}) {
    all.insert(all.end(), rules.begin(), rules.end());
  }
  return all;
}

}  // namespace roadbed::map::validation
