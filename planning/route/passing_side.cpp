#include "roadbed/planning/route/passing_side.h"

#include <cstdint>

namespace roadbed::planning::inline route {

double side_to_pass_on(const map::RoadMap& road_map) {
  int left = 0, right = 0;
  for (std::uint32_t i = 0; i < road_map.lanes().size(); ++i) {
    const map::LaneLinks& links = road_map.graph().of(map::LaneId{i});
    left += links.left && !links.left->same_direction ? 1 : 0;
    right += links.right && !links.right->same_direction ? 1 : 0;
  }
  return right > left ? -1.0 : 1.0;
}

}  // namespace roadbed::planning::route
