#include "roadbed/planning/route/driven_lane.h"

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

}  // namespace roadbed::planning::route
