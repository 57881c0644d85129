#include "roadbed/tools/simulation/ground_truth_monitor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "roadbed/geometry/motion/rectangle.h"

namespace roadbed::tools::inline simulation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

GroundTruthMonitor::GroundTruthMonitor(const World& world, const geometry::VehicleShape& vehicle)
    : world_(world), vehicle_(vehicle), clearance_m_(kInfinity) {}

void GroundTruthMonitor::look(double t_s, const planning::VehicleState& truth) {
  const geometry::Rectangle body = geometry::body_at(truth.map_from_vehicle, vehicle_);
  for (std::size_t i = 0; i < world_.obstacles.size(); ++i) {
    if (!world_.obstacles[i].is_there(t_s)) continue;
    const planning::Obstacle& obstacle = world_.obstacles[i];
    const geometry::Rectangle other = rectangle_at(obstacle, t_s);
    const double bound = (other.centre - body.centre).norm() - other.radius_m() - body.radius_m();
    if (bound >= clearance_m_) continue;
    const double distance = geometry::distance_m(body, other);
    clearance_m_ = std::min(clearance_m_, distance);
    if (distance > 0.0 || collision_) continue;
    const double speed_mps = obstacle.is_static() ? 0.0 : obstacle.motion.at(t_s).speed_mps;
    collision_ = judge_collision(world_.road_map, truth, vehicle_, {obstacle.id, other, speed_mps});
  }
}

double GroundTruthMonitor::take_clearance_m() { return std::exchange(clearance_m_, kInfinity); }

geometry::TrajectoryPoint GroundTruthMonitor::row(double t_s,
                                                  const planning::VehicleState& truth) const {
  const Eigen::Vector2d in_source = world_.road_map.to_source(truth.map_from_vehicle.position());
  return {.t_s = t_s,
          .x_m = in_source.x(),
          .y_m = in_source.y(),
          .heading_rad = truth.map_from_vehicle.heading_rad,
          .speed_mps = truth.speed_mps,
          .acceleration_mps2 = truth.acceleration_mps2,
          .steering_rad = truth.steering_rad,
          .curvature_per_m = std::tan(truth.steering_rad) / vehicle_.wheelbase_m};
}

}  // namespace roadbed::tools::simulation
