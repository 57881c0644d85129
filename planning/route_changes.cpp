#include "roadbed/planning/route_changes.h"

#include <optional>

namespace roadbed::planning {
namespace {

constexpr double kApart_m = 1e-3;

std::optional<map::LaneId> beside(const map::RoadMap& road_map, map::LaneId lane, bool left) {
  const map::LaneLinks& links = road_map.graph().of(lane);
  const auto& neighbour = left ? links.left : links.right;
  return neighbour ? std::optional(neighbour->lane) : std::nullopt;
}

// The successor that has the other lane beside it.
std::optional<map::LaneId> next_beside(const map::RoadMap& road_map, map::LaneId lane,
                                       map::LaneId other, bool left) {
  for (const map::LaneId next : road_map.graph().of(lane).successors) {
    if (beside(road_map, next, left) == other) return next;
  }
  return {};
}

}  // namespace

std::vector<ChangePart> parts_of_change(const map::RoadMap& road_map, const Route& route,
                                        std::size_t leg) {
  const RouteLeg& left_leg = route.legs.at(leg);
  if (!left_leg.change_window) return {};
  const bool left = left_leg.exit == LegExit::change_left;
  std::vector<ChangePart> parts{{leg, left_leg.lane, route.legs.at(leg + 1).lane, 0.0}};
  double offset_m = 0.0;
  for (std::size_t i = leg; i > 0 && left_leg.change_window->from_s_m < offset_m - kApart_m;) {
    const map::LaneId lane = route.legs[--i].lane;
    const auto other = beside(road_map, lane, left);
    if (!other || route.legs[i].exit != LegExit::successor) break;
    offset_m -= road_map.lane(lane).length_m();
    parts.push_back({i, lane, *other, offset_m});
  }
  offset_m = road_map.lane(left_leg.lane).length_m();
  map::LaneId lane = left_leg.lane;
  for (std::size_t i = leg + 2;
       i < route.legs.size() && left_leg.change_window->to_s_m > offset_m + kApart_m; ++i) {
    const auto next = next_beside(road_map, lane, route.legs[i].lane, left);
    if (!next) break;
    lane = *next;
    parts.push_back({i, lane, route.legs[i].lane, offset_m});
    offset_m += road_map.lane(lane).length_m();
  }
  return parts;
}

}  // namespace roadbed::planning
