#pragma once

#include <span>
#include <vector>

#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline obstacles {

/// Obstacles as the planner foresees them: where each will be, and from when to when it is there.
struct Traffic {
  std::span<const Obstacle> obstacles;
};

/// What could be foreseen at one time by looking at the past only: what is there then keeps the
/// bend of its last 0.3 s for two seconds, goes on braking as long, up to a standstill, or speeding
/// up for one, and stays; what is not there yet is not known of.
class PredictedTraffic {
 public:
  PredictedTraffic(const Traffic& truth, double now_s);

  Traffic traffic() const { return {obstacles_}; }
  const std::vector<Obstacle>& obstacles() const { return obstacles_; }

 private:
  std::vector<Obstacle> obstacles_;  ///< in the truth's order
};

}  // namespace roadbed::planning::obstacles
