#include "roadbed/planning/reference/reference_line_data.h"

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline reference {
namespace {

using map::LaneId;

enum class Side { left, right };

// A border, and the fraction of its lane's length beside the point.
struct Edge {
  const map::Lane* lane;
  bool same_direction;
};

const std::optional<map::Neighbour>& beyond(const map::RoadMap& road_map, LaneId lane, Side side) {
  const map::LaneLinks& links = road_map.graph().of(lane);
  return side == Side::left ? links.left : links.right;
}

// The outermost lane that may be used on that side.
Edge outermost(const map::RoadMap& road_map, LaneId lane, Side side) {
  // Neighbours of a broken map could form a ring, hence the count.
  for (std::size_t i = 0; i < road_map.lanes().size(); ++i) {
    const auto& next = beyond(road_map, lane, side);
    if (!next || !next->change_allowed() || !is_drivable(road_map.lane(next->lane).type)) break;
    if (!next->same_direction) return {&road_map.lane(next->lane), false};
    lane = next->lane;
  }
  return {&road_map.lane(lane), true};
}

// Distance to the border along the normal: its point beside is found by walking along it.
double distance_m(const Edge& edge, double fraction, Side side, const geometry::CurvePoint& point) {
  const Eigen::Vector2d along(std::cos(point.heading_rad), std::sin(point.heading_rad));
  const Eigen::Vector2d left(-along.y(), along.x());
  const bool left_border = (side == Side::left) == edge.same_direction;
  const map::LaneLine& border = left_border ? edge.lane->left : edge.lane->right;
  const double forward = edge.same_direction ? 1.0 : -1.0;
  const double length_m = edge.lane->length_m();
  double station_m = length_m * (edge.same_direction ? fraction : 1.0 - fraction);
  Eigen::Vector2d away = map::Lane::point_at(border, station_m) - point.position;
  for (int i = 0; i < 3; ++i) {
    station_m = std::clamp(station_m - forward * away.dot(along), 0.0, length_m);
    away = map::Lane::point_at(border, station_m) - point.position;
  }
  return std::max(0.0, side == Side::left ? away.dot(left) : -away.dot(left));
}

}  // namespace

Corridor room_beside(const map::RoadMap& road_map, LaneId lane, double fraction,
                     const geometry::CurvePoint& point, double default_speed_mps, bool reversed) {
  const auto room_m = [&](Side side) {
    const bool is_left = (side == Side::left) != reversed;
    Edge edge = outermost(road_map, lane, is_left ? Side::left : Side::right);
    edge.same_direction = edge.same_direction != reversed;
    return distance_m(edge, fraction, side, point);
  };
  const auto limit_mps = road_map.lane(lane).least_speed_limit_mps();
  return {room_m(Side::left), room_m(Side::right),
          limit_mps && *limit_mps > 0.0 ? *limit_mps : default_speed_mps};
}

Corridor room_in_lane(const map::RoadMap& road_map, LaneId lane, double fraction,
                      const geometry::CurvePoint& point, bool reversed) {
  const Edge edge{&road_map.lane(lane), !reversed};
  return {distance_m(edge, fraction, Side::left, point),
          distance_m(edge, fraction, Side::right, point), 0.0};
}

}  // namespace roadbed::planning::reference
