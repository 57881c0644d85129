#include "roadbed/tools/simulation/collision.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roadbed::tools::inline simulation {
namespace {

using geometry::Rectangle;

constexpr double kStands_mps = 0.05;
constexpr double kBehind_rad = 150.0 / 180.0 * std::numbers::pi;

Rectangle front_bumper(const Rectangle& body) {
  return {.centre = body.centre + body.half_length_m * body.axis,
          .axis = {-body.axis.y(), body.axis.x()},
          .half_length_m = body.half_width_m};
}

CollisionKind kind_of(const planning::VehicleState& vehicle, const Rectangle& body,
                      const TouchedBody& other) {
  if (std::abs(vehicle.speed_mps) <= kStands_mps) return CollisionKind::stopped_vehicle;
  if (std::abs(other.speed_mps) <= kStands_mps) return CollisionKind::stopped_other;
  const Eigen::Vector2d to = vehicle.map_from_vehicle.inverse() * other.body.centre;
  if (std::abs(std::atan2(to.y(), to.x())) > kBehind_rad) return CollisionKind::rear;
  const bool is_front = geometry::distance_m(front_bumper(body), other.body) <= 0.0;
  return is_front ? CollisionKind::front : CollisionKind::lateral;
}

/// Whether one lane holds all four corners.
bool is_in_one_lane(const map::RoadMap& road_map, const Rectangle& body) {
  const auto lanes_at = [&](const Eigen::Vector2d& corner) {
    return road_map.locate(corner, 0.0, true);
  };
  const auto corners = body.corners();
  return std::ranges::any_of(lanes_at(corners[0]), [&](const map::LaneMatch& lane) {
    return std::all_of(corners.begin() + 1, corners.end(), [&](const Eigen::Vector2d& corner) {
      return std::ranges::any_of(lanes_at(corner), [&](const map::LaneMatch& at) {
        return at.place.lane == lane.place.lane;
      });
    });
  });
}

}  // namespace

std::string_view to_string(CollisionKind kind) {
  switch (kind) {
    case CollisionKind::stopped_vehicle:
      return "stopped vehicle";
    case CollisionKind::stopped_other:
      return "stopped other";
    case CollisionKind::rear:
      return "rear";
    case CollisionKind::front:
      return "front";
    case CollisionKind::lateral:
      return "lateral";
  }
  return "";
}

Collision judge_collision(const map::RoadMap& road_map, const planning::VehicleState& vehicle,
                          const geometry::VehicleShape& shape, const TouchedBody& other) {
  const Rectangle body = geometry::body_at(vehicle.map_from_vehicle, shape);
  const CollisionKind kind = kind_of(vehicle, body, other);
  const bool is_its_own = kind == CollisionKind::stopped_other || kind == CollisionKind::front ||
                          (kind == CollisionKind::lateral && !is_in_one_lane(road_map, body));
  return {.with = other.id, .kind = kind, .is_at_fault = is_its_own};
}

}  // namespace roadbed::tools::simulation
