#include "roadbed/tests/support/mirrored_map.h"

#include <Eigen/Core>
#include <algorithm>
#include <utility>

namespace roadbed::tests {

map::RoadMap mirrored(map::RoadMapParts parts) {
  const auto turn_over = [](Eigen::Vector2d point) {
    return Eigen::Vector2d(point.x(), -point.y());
  };
  for (map::Lane& lane : parts.lanes) {
    std::swap(lane.left, lane.right);
    std::swap(lane.left_marks, lane.right_marks);
    for (map::LaneLine* line : {&lane.left, &lane.centre, &lane.right}) {
      auto points = line->in_map.points();
      std::transform(points.begin(), points.end(), points.begin(), turn_over);
      line->in_map = geometry::Polyline(std::move(points));
    }
    std::transform(lane.polygon.begin(), lane.polygon.end(), lane.polygon.begin(), turn_over);
    std::reverse(lane.polygon.begin(), lane.polygon.end());
  }
  for (map::LaneLinks& links : parts.links) std::swap(links.left, links.right);
  for (map::Signal& signal : parts.signals) signal.in_map = turn_over(signal.in_map);
  return map::RoadMap(std::move(parts));
}

}  // namespace roadbed::tests
