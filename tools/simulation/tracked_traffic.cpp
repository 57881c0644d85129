#include "roadbed/tools/simulation/tracked_traffic.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/planning/obstacles/visibility.h"

namespace roadbed::tools::inline simulation {
namespace {

constexpr double kForeseenFor_s = 5.0, kForeseenStep_s = 0.5;

/// Deviations that the tracker counts with are never less than a good sensor's.
planning::TrackerOptions options_for(const planning::ObjectNoise& noise) {
  planning::TrackerOptions options;
  options.noise.position_m = std::max(options.noise.position_m, noise.position_m);
  options.noise.heading_rad = std::max(options.noise.heading_rad, noise.heading_rad);
  options.noise.speed_mps = std::max(options.noise.speed_mps, noise.speed_mps);
  return options;
}

}  // namespace

TrackedTraffic::TrackedTraffic(const World& world, const Scenario& scenario)
    : world_(world),
      range_m_(scenario.noise.object_range_m),
      sensor_(world, scenario.noise, scenario.seed),
      perceived_(world.road_map, options_for(scenario.noise.object)) {}

std::vector<planning::Obstacle> TrackedTraffic::look(double t_s, const geometry::Rectangle& body,
                                                     const geometry::Pose2& vehicle) {
  const std::vector<SeenObject> seen = sensor_.look(t_s, body);
  track(t_s, seen, body);
  judge(t_s, seen);
  name(seen);
  std::vector<planning::Obstacle> obstacles = perceived_.obstacles(vehicle);
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    if (!obstacles[i].id.empty()) obstacles[i].id = world_.obstacles[obstacle_of(i)].id;
  }
  return obstacles;
}

void TrackedTraffic::track(double t_s, std::span<const SeenObject> seen,
                           const geometry::Rectangle& body) {
  std::vector<planning::Detection> detections;
  std::vector<geometry::Rectangle> bodies;
  for (const SeenObject& object : seen) {
    const planning::Detection& seen_as = detections.emplace_back(object.detection);
    bodies.push_back(planning::body_around(seen_as.centre, seen_as.length_m, seen_as.width_m));
  }
  const planning::Visibility visibility(body, range_m_, std::move(bodies), world_.field,
                                        world_.road_map);
  perceived_.observe(t_s, detections,
                     [&](const Eigen::Vector2d& point) { return !visibility.sees(point); });
  obstacle_of_.resize(perceived_.tracker().slots().size());
}

std::vector<ForeseenMotion> TrackedTraffic::foreseen() const {
  std::vector<ForeseenMotion> all;
  const auto& forecasts = perceived_.forecasts();
  for (std::size_t slot = 0; slot < forecasts.size(); ++slot) {
    for (const planning::ForecastMotion& may : forecasts[slot]) {
      const geometry::Trajectory& motion = may.motion;
      if (motion.points().size() == 1) continue;
      ForeseenMotion& one = all.emplace_back();
      one.obstacle = obstacle_of_[slot];
      one.probability = may.probability;
      for (double after_s = 0.0; after_s <= kForeseenFor_s; after_s += kForeseenStep_s) {
        const geometry::Pose2 pose = motion.at(motion.start_s() + after_s).pose();
        one.points.push_back(world_.road_map.to_source(pose.position()));
      }
    }
  }
  return all;
}

void TrackedTraffic::name(std::span<const SeenObject> seen) {
  const auto slots = perceived_.tracker().slots();
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    if (!slots[slot] || !slots[slot]->detection) continue;
    obstacle_of_[slot] = seen[*slots[slot]->detection].obstacle;
  }
}

void TrackedTraffic::judge(double t_s, std::span<const SeenObject> seen) {
  const auto slots = perceived_.tracker().slots();
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    const auto& track = slots[slot];
    if (!track || !track->detection || track->is_tentative()) continue;
    const SeenObject& of = seen[*track->detection];
    const Eigen::Vector2d truth = world_.obstacles[of.obstacle].pose_at(t_s).position();
    quality_.tracked_m2 += (track->filter.state().pose.position() - truth).squaredNorm();
    quality_.measured_m2 += (of.detection.centre.position() - truth).squaredNorm();
    ++quality_.measurements;
    if (track->measured > 1 && obstacle_of_[slot] != of.obstacle) ++quality_.identity_swaps;
  }
}

}  // namespace roadbed::tools::simulation
