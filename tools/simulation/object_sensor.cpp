#include "roadbed/tools/simulation/object_sensor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/planning/obstacles/visibility.h"

namespace roadbed::tools::inline simulation {
namespace {

constexpr double kMovedOver_s = 0.1;
constexpr double kAlongAxis = 0.7;  // cosine of the angle up to which one moves along one's axis

/// The way that it moves; none before and after its motion, when it rests.
Eigen::Vector2d direction_of(const geometry::Trajectory& motion, double t_s) {
  if (motion.points().size() == 1 || t_s < motion.start_s() || t_s > motion.end_s()) return {0, 0};
  const double from_s = std::max(motion.start_s(), t_s - kMovedOver_s);
  const double to_s = std::min(motion.end_s(), std::max(t_s, from_s + kMovedOver_s));
  const Eigen::Vector2d moved =
      motion.at(to_s).pose().position() - motion.at(from_s).pose().position();
  return moved.norm() > 0.0 ? Eigen::Vector2d(moved.normalized()) : Eigen::Vector2d(0, 0);
}

/// Heading and speed along it. Who walks is measured to head where he walks, wherever he looks, by
/// the sides of the same body; a vehicle that moves backwards backs up, at less than 0.
void set_motion(const planning::Obstacle& obstacle, double t_s, planning::Detection& detection) {
  const Eigen::Vector2d direction = direction_of(obstacle.motion, t_s);
  const double heading_rad = detection.centre.heading_rad;
  const double along = direction.dot(Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad)));
  detection.speed_mps = direction.norm() * obstacle.motion.at(t_s).speed_mps;
  if (detection.speed_mps == 0.0 || along > kAlongAxis) return;
  if (along < -kAlongAxis && obstacle.kind != "pedestrian") {
    detection.speed_mps = -detection.speed_mps;
    return;
  }
  detection.centre.heading_rad = std::atan2(direction.y(), direction.x());
  if (std::abs(along) < kAlongAxis) std::swap(detection.length_m, detection.width_m);
}

}  // namespace

ObjectSensor::ObjectSensor(const World& world, const ScenarioNoise& noise, std::uint64_t seed)
    : world_(world), noise_(noise) {
  std::seed_seq own{seed, std::uint64_t{1}};  // another sequence than that of the vehicle's state
  random_.seed(own);
}

std::vector<SeenObject> ObjectSensor::look(double t_s, const geometry::Rectangle& body) {
  std::vector<SeenObject> seen;
  if (is_blind(t_s)) return seen;
  std::vector<std::size_t> there;
  std::vector<geometry::Rectangle> bodies;
  for (std::size_t i = 0; i < world_.obstacles.size(); ++i) {
    if (!world_.obstacles[i].is_there(t_s)) continue;
    const geometry::Rectangle other = rectangle_at(world_.obstacles[i], t_s);
    if (geometry::distance_m(other, body.centre) > noise_.object_range_m) continue;
    there.push_back(i);
    bodies.push_back(other);
  }
  const planning::Visibility visibility(body, noise_.object_range_m, std::move(bodies),
                                        world_.field, world_.road_map);
  std::bernoulli_distribution is_lost(noise_.dropout_ratio);
  for (std::size_t i = 0; i < there.size(); ++i) {
    if (!visibility.sees_other(i)) continue;
    if (noise_.dropout_ratio > 0.0 && is_lost(random_)) continue;
    seen.push_back({there[i], measured(world_.obstacles[there[i]], t_s)});
  }
  return seen;
}

bool ObjectSensor::is_blind(double t_s) const {
  return std::ranges::any_of(noise_.dropouts, [&](const planning::TimeSpan& span) {
    return t_s >= span.from_s && t_s < span.to_s;
  });
}

planning::Detection ObjectSensor::measured(const planning::Obstacle& obstacle, double t_s) {
  const geometry::Pose2 truth = obstacle.pose_at(t_s);
  planning::Detection detection{.id = "",
                                .kind = obstacle.kind,
                                .length_m = obstacle.length_m,
                                .width_m = obstacle.width_m,
                                .centre = truth};
  set_motion(obstacle, t_s, detection);
  detection.centre.x_m += noise(noise_.object.position_m);
  detection.centre.y_m += noise(noise_.object.position_m);
  detection.centre.heading_rad += noise(noise_.object.heading_rad);
  detection.speed_mps += noise(noise_.object.speed_mps);
  return detection;
}

}  // namespace roadbed::tools::simulation
