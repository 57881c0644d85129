#include "roadbed/planning/route/route_options.h"

#include <algorithm>
#include <array>

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

double enough_room_m(const RouteOptions& options) {
  return std::max(options.comfortable_lane_change_m, options.least_lane_change_m);
}

double default_speed_mps(map::LaneType type) {
  switch (type) {
    case map::LaneType::driving:
    case map::LaneType::bus:
    case map::LaneType::taxi:
    case map::LaneType::tram:
    case map::LaneType::rail:
      return 50.0 / 3.6;
    case map::LaneType::entry:
    case map::LaneType::exit:
    case map::LaneType::on_ramp:
    case map::LaneType::off_ramp:
    case map::LaneType::connecting_ramp:
      return 60.0 / 3.6;
    case map::LaneType::bidirectional:
      return 30.0 / 3.6;
    case map::LaneType::biking:
      return 20.0 / 3.6;
    case map::LaneType::sidewalk:
      return 5.0 / 3.6;
    default:
      return 10.0 / 3.6;
  }
}

std::string_view to_string(map::Participant kind) {
  static constexpr std::array<std::string_view, 10> names = {
      "pedestrian", "bicycle", "motorcycle", "car",  "taxi",
      "bus",        "truck",   "emergency",  "tram", "train"};
  return names.at(static_cast<std::size_t>(kind));
}

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
