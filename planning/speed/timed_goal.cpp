#include "roadbed/planning/speed/timed_goal.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/planning/obstacles/recorded_obstacles.h"

namespace roadbed::planning::inline speed {
namespace {

using geometry::Pose2;
using map::commonroad::CircleShape;
using map::commonroad::PolygonShape;
using map::commonroad::RectangleShape;
using map::commonroad::Shape;

constexpr double kStationStep_m = 0.1;
constexpr double kOffsetStep_m = 0.25;
constexpr int kMostOffsets = 8;

bool is_in(const RectangleShape& shape, const Eigen::Vector2d& point) {
  return geometry::distance_m(rectangle_of(shape), point) <= 0.0;
}

bool is_in(const CircleShape& shape, const Eigen::Vector2d& point) {
  return (point - shape.centre_m).norm() <= shape.radius_m;
}

/// Even-odd rule.
bool is_in(const geometry::Ring& ring, const Eigen::Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Eigen::Vector2d &a = ring[i], &b = ring[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

bool is_in(const PolygonShape& shape, const Eigen::Vector2d& point) {
  return is_in(shape.corners_m, point);
}

Eigen::Vector2d centre_of(const Pose2& rear_axle, const geometry::VehicleShape& vehicle) {
  return rear_axle * Eigen::Vector2d(0.5 * vehicle.length_m - vehicle.rear_overhang_m, 0.0);
}

/// Stations at which a vehicle that drives `d_m` beside the line is where a state wants it.
std::optional<Window> crossing(const GoalState& state, const map::RoadMap& road_map,
                               const ReferenceLine& line, const geometry::VehicleShape& vehicle,
                               double d_m, bool with_heading) {
  std::optional<Window> part;
  const auto steps = static_cast<int>(line.length_m() / kStationStep_m);
  for (int i = 0; i <= steps; ++i) {
    const double s_m = kStationStep_m * i;
    const ReferencePoint at = line.at(s_m);
    const Pose2 pose = Pose2{at.in_map.x(), at.in_map.y(), at.heading_rad} * Pose2{0.0, d_m, 0.0};
    const bool here =
        is_at_place(state, road_map, centre_of(pose, vehicle)) &&
        (!with_heading || !state.heading_rad || holds_heading(*state.heading_rad, at.heading_rad));
    if (here && !part) part = Window{s_m, s_m};
    if (here) part->most = s_m;
    if (!here && part) break;
  }
  return part;
}

/// At the offset nearest to the line at which there is a crossing; left first.
bool find_crossing(const GoalState& state, const map::RoadMap& road_map, const ReferenceLine& line,
                   const geometry::VehicleShape& vehicle, bool with_heading, GoalStretch& stretch) {
  for (int i = 0; i <= kMostOffsets; ++i) {
    for (const double side : {1.0, -1.0}) {
      stretch.d_m = side * kOffsetStep_m * i;
      const auto part = crossing(state, road_map, line, vehicle, stretch.d_m, with_heading);
      if (!part) continue;
      stretch.s_m = *part;
      return true;
    }
  }
  return false;
}

}  // namespace

// The least of heading + 2π k that is not before the window has to be within it.
bool holds_heading(const Window& window, double heading_rad) {
  const double turns = std::ceil((window.least - heading_rad) / (2.0 * std::numbers::pi) - 1e-12);
  return heading_rad + 2.0 * std::numbers::pi * turns <= window.most + 1e-9;
}

bool is_at_place(const GoalState& state, const map::RoadMap& road_map,
                 const Eigen::Vector2d& centre_in_map) {
  if (state.is_anywhere()) return true;
  if (contains(state.region_in_source, road_map.to_source(centre_in_map))) return true;
  return std::ranges::any_of(state.lanes, [&](map::LaneId lane) {
    return is_in(road_map.lane(lane).polygon, centre_in_map);
  });
}

bool contains(const Shape& shape, const Eigen::Vector2d& point) {
  return std::ranges::any_of(shape, [&](const auto& part) {
    return std::visit([&](const auto& form) { return is_in(form, point); }, part);
  });
}

Eigen::Vector2d middle_of(const Shape& shape) { return bounds_of(shape).center(); }

std::optional<double> TimedGoal::latest_s() const {
  if (states.empty()) return std::nullopt;
  return std::ranges::max(states, {}, [](const GoalState& state) { return state.time_s.most; })
      .time_s.most;
}

bool TimedGoal::is_reached(const map::RoadMap& road_map, const Pose2& map_from_vehicle,
                           double speed_mps, double t_s,
                           const geometry::VehicleShape& vehicle) const {
  constexpr double kRounding_s = 1e-6;
  return std::ranges::any_of(states, [&](const GoalState& state) {
    return t_s >= state.time_s.least - kRounding_s && t_s <= state.time_s.most + kRounding_s &&
           state.speed_mps.holds(speed_mps) &&
           (!state.heading_rad ||
            holds_heading(*state.heading_rad, map_from_vehicle.heading_rad)) &&
           is_at_place(state, road_map, centre_of(map_from_vehicle, vehicle));
  });
}

std::vector<GoalStretch> goal_stretches(const TimedGoal& goal, const map::RoadMap& road_map,
                                        const ReferenceLine& line,
                                        const geometry::VehicleShape& vehicle) {
  std::vector<GoalStretch> stretches;
  for (const GoalState& state : goal.states) {
    GoalStretch stretch{.time_s = state.time_s, .speed_mps = state.speed_mps};
    bool found = state.is_anywhere();
    for (const bool with_heading : {true, false}) {
      found = found || find_crossing(state, road_map, line, vehicle, with_heading, stretch);
    }
    if (found) stretches.push_back(stretch);
  }
  return stretches;
}

}  // namespace roadbed::planning::speed
