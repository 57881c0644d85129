#include "roadbed/planning/obstacles/movers_on_line.h"

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline obstacles {

bool MoverOnLine::shares_way(double at_d_m, const geometry::VehicleShape& vehicle) const {
  constexpr double kApart_m = 0.3;  // sides that far apart do not matter to each other
  return std::abs(d_m - at_d_m) < half_width_m + 0.5 * vehicle.width_m + kApart_m;
}

bool MoverOnLine::is_closely_ahead_of(const MoverOnLine& other) const {
  constexpr double kQueueGap_m = 15.0;
  return s_m > other.s_m && rear_m() < other.front_m() + kQueueGap_m &&
         std::abs(d_m - other.d_m) <= half_width_m + other.half_width_m;
}

std::vector<MoverOnLine> movers_on_line(const ReferenceLine& line, const Traffic& traffic,
                                        double t_s, bool with_standing) {
  std::vector<MoverOnLine> movers;
  for (std::size_t i = 0; i < traffic.obstacles.size(); ++i) {
    const Obstacle& obstacle = traffic.obstacles[i];
    if ((obstacle.is_static() && !with_standing) || !obstacle.is_there(t_s)) continue;
    const geometry::TrajectoryPoint now = obstacle.motion.at(t_s);
    const geometry::LinePosition at = line.project(now.pose().position());
    const double turned = now.heading_rad - line.at(at.s_m).heading_rad;
    const double along = std::abs(std::cos(turned)), across = std::abs(std::sin(turned));
    movers.push_back(
        {.obstacle = i,
         .s_m = at.s_m,
         .d_m = at.d_m,
         .half_length_m = 0.5 * (obstacle.length_m * along + obstacle.width_m * across),
         .half_width_m = 0.5 * (obstacle.width_m * along + obstacle.length_m * across),
         .speed_mps = obstacle.is_static() ? 0.0 : now.speed_mps * std::cos(turned),
         .stands = obstacle.is_static()});
  }
  return movers;
}

bool is_braking(const Obstacle& obstacle, double t_s) {
  constexpr double kOver_s = 0.5, kLeast_mps2 = 1.0;
  const auto speed_mps = [&](double at_s) { return obstacle.motion.at(at_s).speed_mps; };
  const double now_mps = speed_mps(t_s);
  return std::max(speed_mps(t_s - kOver_s) - now_mps, now_mps - speed_mps(t_s + kOver_s)) >
         kLeast_mps2 * kOver_s;
}

}  // namespace roadbed::planning::obstacles
