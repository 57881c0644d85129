#include "roadbed/tests/support/random_drive.h"

#include <utility>
#include <vector>

namespace roadbed::tests {

using geometry::Trajectory;
using geometry::TrajectoryPoint;

TrajectoryPoint random_start(std::mt19937& random, const Eigen::Vector2d& around, double spread_m,
                             double heading_rad) {
  std::uniform_real_distribution<double> aside(-spread_m, spread_m);
  std::uniform_real_distribution<double> heading(-heading_rad, heading_rad);
  return {.t_s = 0.0,
          .x_m = around.x() + aside(random),
          .y_m = around.y() + aside(random),
          .heading_rad = heading(random)};
}

Trajectory random_drive(std::mt19937& random, const TrajectoryPoint& first,
                        const DriveSteps& steps) {
  std::uniform_real_distribution<double> way(-steps.way_m, steps.way_m);
  std::uniform_real_distribution<double> turn(-steps.turn_rad, steps.turn_rad);
  std::vector<TrajectoryPoint> rows{first};
  while (rows.size() <= steps.rows) {
    const TrajectoryPoint last = rows.back();
    rows.push_back({.t_s = last.t_s + steps.step_s,
                    .x_m = last.x_m + way(random),
                    .y_m = last.y_m + way(random),
                    .heading_rad = last.heading_rad + turn(random)});
  }
  return Trajectory(std::move(rows));
}

}  // namespace roadbed::tests
