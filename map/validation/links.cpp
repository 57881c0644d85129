#include <fmt/format.h>

#include <algorithm>

#include "roadbed/map/components.h"
#include "roadbed/map/validation/rules.h"

namespace roadbed::map::rules {
namespace {

constexpr const char* kAcrossSections =
    "asam.net:xodr:1.4.0:road.lane.link.lanes_across_lane_sections";

bool holds(const std::vector<LaneId>& lanes, LaneId lane) {
  return std::find(lanes.begin(), lanes.end(), lane) != lanes.end();
}

Finding one_sided(const RoadMap& road_map, const Lane& lane, LaneId other, const char* relation,
                  const char* back) {
  return {.rule = "link.one-sided",
          .asam_rule = kAcrossSections,
          .severity = is_drivable(lane.type) ? Severity::error : Severity::warning,
          .element = "lane " + lane.name,
          .in_map = lane.pose_at(0.5 * lane.length_m()).position(),
          .message = fmt::format("has lane {} as {}, which does not have it as {}; add the missing "
                                 "link or remove this one",
                                 road_map.lane(other).name, relation, back)};
}

double start_width_m(const Lane& lane) { return lane.width_m(0.0); }
double end_width_m(const Lane& lane) { return lane.width_m(lane.length_m()); }

Finding zero_width_link(const Lane& lane, const char* end, const char* relation,
                        const Eigen::Vector2d& in_map) {
  return {.rule = "link.zero-width",
          .asam_rule = fmt::format("asam.net:xodr:1.7.0:road.lane.link.zero_width_at_{}", end),
          .severity = Severity::warning,
          .element = "lane " + lane.name,
          .in_map = in_map,
          .message =
              fmt::format("has no width at its {} but a {} there; remove the link", end, relation)};
}

}  // namespace

Findings one_sided_links(const RoadMap& road_map, const ValidateOptions&) {
  Findings findings;
  const LaneGraph& graph = road_map.graph();
  for (const Lane& lane : road_map.lanes()) {
    for (const LaneId to : graph.of(lane.id).successors) {
      if (holds(graph.of(to).predecessors, lane.id)) continue;
      findings.push_back(one_sided(road_map, lane, to, "successor", "predecessor"));
    }
    for (const LaneId from : graph.of(lane.id).predecessors) {
      if (holds(graph.of(from).successors, lane.id)) continue;
      findings.push_back(one_sided(road_map, lane, from, "predecessor", "successor"));
    }
  }
  return findings;
}

Findings zero_width_links(const RoadMap& road_map, const ValidateOptions&) {
  constexpr double kNone = 1e-3;  // [m]
  Findings findings;
  for (const Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type)) continue;
    const LaneLinks& links = road_map.graph().of(lane.id);
    const auto& centre = lane.centre.in_map.points();
    if (!links.predecessors.empty() && start_width_m(lane) < kNone) {
      findings.push_back(zero_width_link(lane, "start", "predecessor", centre.front()));
    }
    if (!links.successors.empty() && end_width_m(lane) < kNone) {
      findings.push_back(zero_width_link(lane, "end", "successor", centre.back()));
    }
  }
  return findings;
}

Findings dead_ends(const RoadMap& road_map, const ValidateOptions&) {
  Findings findings;
  for (const Lane& lane : road_map.lanes()) {
    if (!is_drivable(lane.type) || !road_map.graph().of(lane.id).successors.empty()) continue;
    const bool in_junction = lane.junction.has_value();
    findings.push_back(
        {.rule = "link.dead-end",
         .asam_rule = {},
         .severity = in_junction ? Severity::warning : Severity::info,
         .element = "lane " + lane.name,
         .in_map = lane.centre.in_map.points().back(),
         .message = in_junction ? "leads into its junction but not out; link its end to a lane"
                                : "leads nowhere; link its end if the road goes on"});
  }
  return findings;
}

Findings separate_parts(const RoadMap& road_map, const ValidateOptions&) {
  Findings findings;
  const auto components = drivable_components(road_map);
  for (std::size_t i = 1; i < components.size(); ++i) {
    const Lane& first = road_map.lane(components[i].front());
    findings.push_back({.rule = "link.separate-part",
                        .asam_rule = {},
                        .severity = Severity::info,
                        .element = "lane " + first.name,
                        .in_map = first.pose_at(0.5 * first.length_m()).position(),
                        .message = fmt::format(
                            "{} with no link or lane change to the largest connected part; add "
                            "links if it should be reached",
                            components[i].size() == 1
                                ? std::string("is one lane")
                                : fmt::format("begins a part of {} lanes", components[i].size()))});
  }
  return findings;
}

}  // namespace roadbed::map::rules
