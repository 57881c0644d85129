#include "roadbed/planning/route/route_changes.h"

#include <optional>

namespace roadbed::planning::inline route {

std::optional<DrivenLane> beside(const map::RoadMap& road_map, const DrivenLane& lane, bool left) {
  const map::LaneLinks& links = road_map.graph().of(lane.lane);
  const auto& neighbour = left != lane.reversed ? links.left : links.right;
  if (!neighbour) return {};
  return DrivenLane{neighbour->lane, neighbour->same_direction == lane.reversed};
}

std::vector<DrivenLane> following(const map::RoadMap& road_map, const DrivenLane& lane) {
  const map::LaneLinks& links = road_map.graph().of(lane.lane);
  std::vector<DrivenLane> lanes;
  for (const map::LaneId next : lane.reversed ? links.predecessors : links.successors) {
    lanes.push_back({next, lane.reversed});
  }
  return lanes;
}

double mirrored_m(const map::RoadMap& road_map, const DrivenLane& lane, double s_m) {
  return lane.reversed ? road_map.lane(lane.lane).length_m() - s_m : s_m;
}

namespace {

constexpr double kApart_m = 1e-3;

// The lane behind that has the other lane beside it.
std::optional<DrivenLane> next_beside(const map::RoadMap& road_map, const DrivenLane& lane,
                                      const DrivenLane& other, bool left) {
  for (const DrivenLane& next : following(road_map, lane)) {
    if (beside(road_map, next, left) == other) return next;
  }
  return {};
}

}  // namespace

map::StationRange driven_window(const map::RoadMap& road_map, const RouteLeg& leg) {
  const DrivenLane lane = driven_lane(leg);
  return {mirrored_m(road_map, lane, leg.change_window->from_s_m),
          mirrored_m(road_map, lane, leg.change_window->to_s_m)};
}

std::vector<ChangePart> parts_of_change(const map::RoadMap& road_map, const Route& route,
                                        std::size_t leg) {
  const RouteLeg& left_leg = route.legs.at(leg);
  if (!left_leg.change_window) return {};
  const bool left = left_leg.exit == LegExit::change_left;
  const map::StationRange window = driven_window(road_map, left_leg);
  std::vector<ChangePart> parts{
      {leg, driven_lane(left_leg), driven_lane(route.legs.at(leg + 1)), 0.0}};
  double offset_m = 0.0;
  for (std::size_t i = leg; i > 0 && window.from_s_m < offset_m - kApart_m;) {
    const DrivenLane lane = driven_lane(route.legs[--i]);
    const auto other = beside(road_map, lane, left);
    if (!other || route.legs[i].exit != LegExit::successor) break;
    offset_m -= road_map.lane(lane.lane).length_m();
    parts.push_back({i, lane, *other, offset_m});
  }
  offset_m = road_map.lane(left_leg.lane).length_m();
  DrivenLane lane = driven_lane(left_leg);
  for (std::size_t i = leg + 2; i < route.legs.size() && window.to_s_m > offset_m + kApart_m; ++i) {
    const auto next = next_beside(road_map, lane, driven_lane(route.legs[i]), left);
    if (!next) break;
    lane = *next;
    parts.push_back({i, lane, driven_lane(route.legs[i]), offset_m});
    offset_m += road_map.lane(lane.lane).length_m();
  }
  return parts;
}

}  // namespace roadbed::planning::route
