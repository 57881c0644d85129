#include "roadbed/tools/simulation/object_sensor.h"

#include <algorithm>
#include <utility>

#include "roadbed/planning/obstacles/visibility.h"

namespace roadbed::tools::inline simulation {
namespace {

/// Along its heading; before and after its motion it rests.
double true_speed_mps(const planning::Obstacle& obstacle, double t_s) {
  const geometry::Trajectory& motion = obstacle.motion;
  const bool moves = !obstacle.is_static() && t_s >= motion.start_s() && t_s <= motion.end_s();
  return moves ? motion.at(t_s).speed_mps : 0.0;
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
                                .centre = truth,
                                .speed_mps = true_speed_mps(obstacle, t_s)};
  detection.centre.x_m += noise(noise_.object.position_m);
  detection.centre.y_m += noise(noise_.object.position_m);
  detection.centre.heading_rad += noise(noise_.object.heading_rad);
  detection.speed_mps += noise(noise_.object.speed_mps);
  return detection;
}

}  // namespace roadbed::tools::simulation
