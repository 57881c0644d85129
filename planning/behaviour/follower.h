#pragma once

#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline behaviour {

/// Where the vehicle is: station and lateral offset of its rear axle.
struct VehicleOnLine {
  const ReferenceLine& line;
  double s_m, d_m, width_m;
};

/// Whether an obstacle drives behind the vehicle in its lane, and so has to keep its distance: its
/// centre is behind the rear axle, its body behind the vehicle's, and it heads along the line (up
/// to 37 degrees). O(N) in the line's points.
bool is_following(const Obstacle& obstacle, double t_s, const VehicleOnLine& vehicle);

}  // namespace roadbed::planning::behaviour
