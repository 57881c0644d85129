#include "roadbed/planning/tracking/perceived_traffic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/derived/lane_relations.h"

namespace roadbed::planning::inline tracking {
namespace {

constexpr double kLikely = 0.15;  // what is less so is not planned for
constexpr double kSameWay_rad = 0.6, kOncoming_rad = 2.4, kTurn_rad = 0.6;
constexpr TimeSpan kNever{std::numeric_limits<double>::infinity(),
                          -std::numeric_limits<double>::infinity()};

/// What was driven, and what is foreseen of it.
geometry::Trajectory joined(const Track& track, const geometry::Trajectory& ahead) {
  if (ahead.points().size() == 1) return ahead;  // it stands
  std::vector<geometry::TrajectoryPoint> points;
  for (const geometry::TrajectoryPoint& before : track.past) {
    if (before.t_s < ahead.start_s()) points.push_back(before);
  }
  points.insert(points.end(), ahead.points().begin(), ahead.points().end());
  return geometry::Trajectory(std::move(points));
}

}  // namespace

PerceivedTraffic::PerceivedTraffic(const map::RoadMap& road_map, const TrackerOptions& options)
    : road_map_(road_map),
      noise_(options.noise),
      tracker_(options),
      lane_forecast_(road_map),
      across_oncoming_(map::drives_on_the_left(road_map) ? -1.0 : 1.0) {}

MotionBounds PerceivedTraffic::expected() const {
  MotionBounds bounds = by_the_rules();
  bounds.position_error_m = 2.0 * noise_.position_m;
  bounds.speed_error_mps = 2.0 * noise_.speed_mps;
  return bounds;
}

void PerceivedTraffic::observe(double t_s, std::span<const Detection> detections,
                               const Tracker::IsHidden& is_hidden) {
  tracker_.observe(t_s, detections, is_hidden);
  forecast();
}

void PerceivedTraffic::foresee(double t_s) {
  tracker_.foresee(t_s);
  forecast();
}

void PerceivedTraffic::forecast() {
  const auto slots = tracker_.slots();
  forecasts_.assign(slots.size(), {});
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i]) forecasts_[i] = lane_forecast_.motions(slots, i);
  }
}

std::vector<Obstacle> PerceivedTraffic::obstacles(const geometry::Pose2& map_from_vehicle) {
  const auto slots = tracker_.slots();
  const geometry::Trajectory nowhere{std::vector<geometry::TrajectoryPoint>(1)};
  std::vector<Obstacle> obstacles(kPlacesPerSlot * slots.size(),
                                  {.id = "", .motion = nowhere, .validity = kNever});
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (!slots[i]) continue;
    for (std::size_t k = 0; k < forecasts_[i].size(); ++k) {
      const ForecastMotion& may = forecasts_[i][k];
      if (k > 0 && !is_planned_for(may, map_from_vehicle.heading_rad)) continue;
      obstacles[kPlacesPerSlot * i + k] = {.id = slots[i]->id,
                                           .kind = slots[i]->kind,
                                           .length_m = slots[i]->length_m,
                                           .width_m = slots[i]->width_m,
                                           .motion = joined(*slots[i], may.motion),
                                           .validity = {slots[i]->first_s, kAlways.to_s}};
    }
  }
  return obstacles;
}

/// Whether a motion that is not the most likely one matters: not of who drives the same way and
/// is followed or passed as he is, nor of who comes the other way and would have to give way.
bool PerceivedTraffic::is_planned_for(const ForecastMotion& motion, double vehicle_heading_rad) {
  if (motion.probability < kLikely) return false;
  const double towards_rad = std::abs(
      geometry::wrap_angle(motion.motion.points().front().heading_rad - vehicle_heading_rad));
  if (towards_rad < kSameWay_rad) return false;
  return towards_rad < kOncoming_rad || !has_to_give_way(motion);
}

/// Who turns across oncoming traffic has; not who stays in a roundabout, which turns as far.
bool PerceivedTraffic::has_to_give_way(const ForecastMotion& motion) {
  const std::vector<geometry::TrajectoryPoint>& points = motion.motion.points();
  const double turn_rad = points.back().heading_rad - points.front().heading_rad;
  if (across_oncoming_ * turn_rad < kTurn_rad) return false;
  if (motion.lanes.empty()) return true;
  const Eigen::Vector2d from(points.front().x_m, points.front().y_m);
  double begins_m = -road_map_.lane(motion.lanes.front()).centre.in_map.project(from).s_m;
  for (const map::LaneId lane : motion.lanes) {
    if (begins_m > kForeseen_s * points.front().speed_mps) break;
    const auto [known, is_new] = crosses_oncoming_.try_emplace(lane);
    if (is_new) known->second = map::crosses_oncoming(road_map_, lane);
    if (known->second) return true;
    begins_m += road_map_.lane(lane).length_m();
  }
  return false;
}

}  // namespace roadbed::planning::tracking
