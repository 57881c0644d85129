#include "roadbed/planning/rules/speed_limit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::planning::inline rules {

std::optional<LaneLimit> limit_along(const map::RoadMap& road_map,
                                     std::span<const map::LaneMatch> lanes, double heading_rad) {
  const auto is_along = [&](const map::LaneMatch& match) {
    const double turn_rad = geometry::wrap_angle(heading_rad - match.heading_rad);
    return std::abs(turn_rad) < 0.5 * std::numbers::pi;
  };
  const bool is_against_all = std::ranges::none_of(lanes, is_along);
  std::optional<LaneLimit> fastest;
  for (const map::LaneMatch& match : lanes) {
    if (!is_against_all && !is_along(match)) continue;
    const map::Lane& lane = road_map.lane(match.place.lane);
    const std::optional<double> limit_mps = lane.speed_limit_at_mps(match.place.s_m);
    if (limit_mps && !(fastest && fastest->limit_mps >= *limit_mps)) fastest = {*limit_mps, &lane};
  }
  return fastest;
}

std::vector<std::optional<LaneLimit>> limits_along(const map::RoadMap& road_map,
                                                   const geometry::Trajectory& drive_in_source) {
  const std::vector<geometry::TrajectoryPoint>& rows = drive_in_source.points();
  std::vector<Eigen::Vector2d> places;
  for (const geometry::TrajectoryPoint& row : rows) {
    places.push_back(road_map.to_map(row.pose().position()));
  }
  constexpr double in_lane_m = 1e-3;
  constexpr std::size_t most_lanes = 16;
  const map::LaneMatches lanes = road_map.locate(places, in_lane_m, most_lanes, true);
  std::vector<std::optional<LaneLimit>> limits;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    limits.push_back(limit_along(road_map, lanes.of(i), rows[i].heading_rad));
  }
  return limits;
}

}  // namespace roadbed::planning::rules
