#include "roadbed/planning/behaviour/driving_task.h"

namespace roadbed::planning::inline behaviour {

std::vector<Obstacle> DrivingTask::obstacles_at(double t_s) const {
  std::vector<Obstacle> there;
  for (const Obstacle& obstacle : obstacles) {
    if (obstacle.is_there(t_s)) there.push_back(obstacle);
  }
  return there;
}

SpeedCeiling ceiling_of(const ReferenceLine& line, const geometry::VehicleShape& vehicle,
                        const DrivingOptions& options) {
  return speed_ceiling(line, vehicle,
                       {.desired_speed_mps = options.desired_speed_mps,
                        .max_lateral_acceleration_mps2 = options.max_lateral_acceleration_mps2,
                        .deceleration_mps2 = options.comfort_deceleration_mps2});
}

}  // namespace roadbed::planning::behaviour
