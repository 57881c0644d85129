#include <fmt/format.h>

#include <algorithm>

#include "roadbed/map/validation/rules.h"

namespace roadbed::map::rules {
namespace {

bool lacks_speed(const Lane& lane) {
  return is_drivable(lane.type) && !lane.least_speed_limit_mps();
}

bool has_speed(const Lane& lane) { return is_drivable(lane.type) && lane.least_speed_limit_mps(); }

Finding missing(const std::string& element, std::optional<Eigen::Vector2d> in_map,
                std::string message) {
  return {.rule = "speed.missing",
          .asam_rule = {},
          .severity = Severity::info,
          .element = element,
          .in_map = in_map,
          .message = std::move(message)};
}

Findings missing_of_roads(const RoadMap& road_map) {
  Findings findings;
  for (const Road& road : road_map.roads()) {
    const auto count = std::count_if(road.lanes.begin(), road.lanes.end(),
                                     [&](LaneId id) { return lacks_speed(road_map.lane(id)); });
    if (count == 0) continue;
    findings.push_back(
        missing("road " + road.source_id, road.reference_in_map.at(0.0),
                fmt::format("{} of its drivable lanes have no speed limit; add one", count)));
  }
  return findings;
}

Findings missing_of_lanes_without_road(const RoadMap& road_map) {
  Findings findings;
  for (const Lane& lane : road_map.lanes()) {
    if (lane.road || !lacks_speed(lane)) continue;
    findings.push_back(
        missing("lane " + lane.name, lane.pose_at(0.0).position(), "has no speed limit; add one"));
  }
  return findings;
}

}  // namespace

/// One finding for a map that says no speed at all, else one per road.
Findings missing_speeds(const RoadMap& road_map, const ValidateOptions&) {
  const auto& lanes = road_map.lanes();
  if (std::none_of(lanes.begin(), lanes.end(), has_speed)) {
    if (std::none_of(lanes.begin(), lanes.end(), lacks_speed)) return {};
    return {missing("map", std::nullopt, "no drivable lane has a speed limit; add them")};
  }
  Findings findings = missing_of_roads(road_map);
  for (Finding& finding : missing_of_lanes_without_road(road_map)) {
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace roadbed::map::rules
