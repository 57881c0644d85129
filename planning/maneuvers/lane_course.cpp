#include "roadbed/planning/maneuvers/lane_course.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "roadbed/geometry/primitives/angle.h"

namespace roadbed::planning::inline maneuvers {
namespace {

using map::LaneId;

constexpr double kStands_mps = 0.5, kAlong = 0.5;  // cosine: up to 60° from the lane

double turn_over(const map::Lane& lane) {
  const double from = lane.pose_at(0.0).heading_rad;
  return std::abs(geometry::wrap_angle(lane.pose_at(lane.length_m()).heading_rad - from));
}

std::optional<LaneId> straightest(const map::RoadMap& road_map, const std::vector<LaneId>& lanes) {
  std::optional<LaneId> best;
  for (const LaneId id : lanes) {
    if (!map::is_drivable(road_map.lane(id).type)) continue;
    if (!best || turn_over(road_map.lane(id)) < turn_over(road_map.lane(*best))) best = id;
  }
  return best;
}

}  // namespace

std::vector<LaneId> with_lanes_before(const map::RoadMap& road_map, LaneId lane, double length_m) {
  constexpr std::size_t kMost = 50;
  std::vector<LaneId> lanes{lane};
  for (double back_m = 0.0; back_m < length_m && lanes.size() < kMost;) {
    const auto before = straightest(road_map, road_map.graph().of(lanes.back()).predecessors);
    if (!before) break;
    lanes.push_back(*before);
    back_m += road_map.lane(*before).length_m();
  }
  std::ranges::reverse(lanes);
  return lanes;
}

geometry::Polyline middle_of(const map::RoadMap& road_map, const std::vector<LaneId>& lanes) {
  constexpr double kJoint_m = 0.05;
  std::vector<Eigen::Vector2d> points;
  for (const LaneId id : lanes) {
    for (const Eigen::Vector2d& point : road_map.lane(id).centre.in_map.points()) {
      if (points.empty() || (point - points.back()).norm() > kJoint_m) points.push_back(point);
    }
  }
  return geometry::Polyline(std::move(points));
}

std::vector<MoverOnLane> movers_on_lane(const geometry::Polyline& lane, const Traffic& traffic,
                                        double t_s, double within_m) {
  std::vector<MoverOnLane> movers;
  for (std::size_t i = 0; i < traffic.obstacles.size(); ++i) {
    const Obstacle& obstacle = traffic.obstacles[i];
    if (!obstacle.is_there(t_s)) continue;
    const geometry::TrajectoryPoint now = obstacle.motion.at(t_s);
    const geometry::LinePosition at = lane.project(now.pose().position());
    if (std::abs(at.d_m) > within_m) continue;
    const double along = std::cos(now.heading_rad - lane.pose_at(at.s_m).heading_rad);
    const double speed_mps = obstacle.is_static() ? 0.0 : now.speed_mps;
    if (speed_mps > kStands_mps && along < kAlong) continue;
    movers.push_back({.obstacle = i,
                      .s_m = at.s_m,
                      .half_length_m = 0.5 * obstacle.length_m,
                      .speed_mps = speed_mps * along});
  }
  return movers;
}

}  // namespace roadbed::planning::maneuvers
