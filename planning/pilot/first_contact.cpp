#include "roadbed/planning/pilot/first_contact.h"

#include <limits>

namespace roadbed::planning::inline pilot {
namespace {

bool meets(const geometry::Pose2& pose, const geometry::VehicleShape& vehicle,
           const Obstacle& other, double t_s) {
  const geometry::Pose2 there = other.pose_at(t_s);
  const double reach_m = vehicle.length_m + other.length_m + vehicle.width_m + other.width_m;
  if ((there.position() - pose.position()).squaredNorm() > reach_m * reach_m) return false;
  const double ahead_m = (pose.inverse() * there.position()).x();
  if (ahead_m < -vehicle.rear_overhang_m) return false;
  return geometry::distance_m(geometry::body_at(pose, vehicle), rectangle_at(other, t_s)) <= 0.0;
}

}  // namespace

double first_contact_s(const geometry::Trajectory& drive, const geometry::VehicleShape& vehicle,
                       std::span<const Obstacle> obstacles) {
  for (const geometry::TrajectoryPoint& row : drive.points()) {
    for (const Obstacle& other : obstacles) {
      if (other.is_there(row.t_s) && meets(row.pose(), vehicle, other, row.t_s)) return row.t_s;
    }
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace roadbed::planning::pilot
