#include "roadbed/planning/route_obstacle.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "roadbed/geometry/point_index.h"
#include "roadbed/planning/route_search.h"

namespace roadbed::planning {
namespace {

using map::LaneId;

// Lanes that lead to `goal`, by links and permitted changes, in order of id.
std::vector<LaneId> lanes_to(const TravelRules& rules, LaneId goal) {
  const map::LaneGraph& graph = rules.road_map().graph();
  std::vector<bool> seen(graph.size(), false);
  if (!rules.may_enter(goal)) return {goal};
  std::vector<LaneId> open{goal}, found;
  seen[goal.index] = true;
  const auto visit = [&](LaneId lane) {
    if (seen[lane.index] || !rules.may_enter(lane)) return;
    seen[lane.index] = true;
    open.push_back(lane);
  };
  while (!open.empty()) {
    const LaneId lane = open.back();
    open.pop_back();
    found.push_back(lane);
    const map::LaneLinks& links = graph.of(lane);
    for (const LaneId before : links.predecessors) visit(before);
    for (const auto& beside : {links.left, links.right}) {
      if (!beside) continue;
      const map::LaneLinks& back = graph.of(beside->lane);
      for (const auto& there : {back.left, back.right}) {
        if (there && there->lane == lane && rules.may_change(beside->lane, *there, 0, 1.0)) {
          visit(beside->lane);
        }
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

void find_gap(const map::RoadMap& road_map, const std::vector<LaneId>& from_start,
              const std::vector<LaneId>& to_goal, RouteObstacle& obstacle) {
  std::vector<Eigen::Vector2d> starts;
  for (const LaneId lane : to_goal) starts.push_back(road_map.lane(lane).pose_at(0.0).position());
  const geometry::PointIndex index(std::move(starts));
  obstacle.gap_m = std::numeric_limits<double>::infinity();
  for (const LaneId id : from_start) {
    const map::Lane& lane = road_map.lane(id);
    const auto nearest = index.nearest(lane.pose_at(lane.length_m()).position());
    if (!nearest || nearest->distance_m >= obstacle.gap_m) continue;
    obstacle.gap_m = nearest->distance_m;
    obstacle.gap_from = id;
    obstacle.gap_to = to_goal[nearest->index];
  }
}

std::string cause(const RouteObstacle& obstacle) {
  if (obstacle.closed_lanes) return "; closed lanes stand between";
  if (obstacle.markings) return "; only across markings that may not be crossed there is a way";
  if (obstacle.length) return "; the lanes are too short for the lane changes that it takes";
  return "";
}

}  // namespace

RouteObstacle find_obstacle(const map::RoadMap& road_map, const map::LanePlace& from,
                            const map::LanePlace& to, const RouteOptions& options,
                            const std::vector<LaneId>& reached) {
  const auto with = [&](Leniency leniency) {
    return search(TravelRules(road_map, options, leniency), from, to).passages.has_value();
  };
  RouteObstacle obstacle;
  const std::vector<LaneId> to_goal = lanes_to(TravelRules(road_map, options, {}), to.lane);
  obstacle.lanes_from_start = reached.size();
  obstacle.lanes_to_goal = to_goal.size();
  find_gap(road_map, reached, to_goal, obstacle);
  obstacle.closed_lanes = with({.closed_lanes = true});
  obstacle.markings = with({.markings = true});
  obstacle.length = with({.length = true});
  return obstacle;
}

std::string describe(const map::RoadMap& road_map, const map::LanePlace& from,
                     const map::LanePlace& to, const RouteObstacle& obstacle) {
  std::string text = fmt::format(
      "no lane sequence leads from lane {} to lane {}: {} lanes can be reached from the start, the "
      "goal from {}",
      road_map.lane(from.lane).name, road_map.lane(to.lane).name, obstacle.lanes_from_start,
      obstacle.lanes_to_goal);
  if (obstacle.gap_from && obstacle.gap_to) {
    text += fmt::format("; they come nearest where lane {} ends {:.2f} m from the start of lane {}",
                        road_map.lane(*obstacle.gap_from).name, obstacle.gap_m,
                        road_map.lane(*obstacle.gap_to).name);
  }
  return text + cause(obstacle);
}

}  // namespace roadbed::planning
