#include "roadbed/planning/route/closures.h"

#include <algorithm>

#include "roadbed/map/index/road_map_index.h"

namespace roadbed::planning::inline route {
namespace {

struct Box {
  Eigen::Vector2d low, high;
};

Box box_of(const geometry::Ring& ring) {
  Box box{ring.front(), ring.front()};
  for (const Eigen::Vector2d& point : ring) {
    box.low = box.low.cwiseMin(point);
    box.high = box.high.cwiseMax(point);
  }
  return box;
}

bool overlap(const Box& a, const Box& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

double side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& point) {
  const Eigen::Vector2d along = b - a, to_point = point - a;
  return along.x() * to_point.y() - along.y() * to_point.x();
}

bool cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
           const Eigen::Vector2d& d) {
  return side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
}

bool edges_cross(const geometry::Ring& one, const geometry::Ring& other) {
  for (std::size_t i = 0; i < one.size(); ++i) {
    for (std::size_t j = 0; j < other.size(); ++j) {
      if (cross(one[i], one[(i + 1) % one.size()], other[j], other[(j + 1) % other.size()])) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

std::vector<map::LaneId> lanes_touching(const map::RoadMap& road_map,
                                        const geometry::Ring& region_in_map) {
  std::vector<map::LaneId> lanes;
  if (region_in_map.size() < 3) return lanes;
  const Box region = box_of(region_in_map);
  for (const map::LaneId id :
       road_map.index().lanes.in_box(region.low, region.high, map::LaneTypes::all())) {
    const map::Lane& lane = road_map.lane(id);
    if (!overlap(region, box_of(lane.polygon))) continue;
    if (geometry::contains(region_in_map, lane.polygon.front()) ||
        geometry::contains(lane.polygon, region_in_map.front()) ||
        edges_cross(region_in_map, lane.polygon)) {
      lanes.push_back(lane.id);
    }
  }
  return lanes;
}

}  // namespace roadbed::planning::route
