#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "roadbed/planning/plan.h"

namespace roadbed::benchmark_scene {

/// Way-points `x,y` [m], one row each, no header.
/// @throws InputError naming the line that is not two numbers.
std::vector<Eigen::Vector2d> read_way_points(const std::filesystem::path& file);

/// The cycle that is timed: 12 m/s, 0.3 m/s², 0.2 m beside the line at station 70 m, on a road of
/// ±4.5 m; ten cars at 8 m/s ahead, in turn to the right, on the line and to the left.
struct PlannerScene {
  /// @param blocked  the ten cars are one behind the other to the right of the line, at 3 m/s:
  /// hundreds
  ///                 of candidates that collide are cheaper than the one that is chosen.
  explicit PlannerScene(const std::vector<Eigen::Vector2d>& way_points, bool blocked = false);

  planning::PlanInput input() const;

  planning::ReferenceLine line;
  planning::LateralState start;
  planning::SpeedPlan speed;
  std::vector<planning::Obstacle> obstacles;
};

/// 71 × 76 end states.
planning::PlanOptions options_with(int points);

}  // namespace roadbed::benchmark_scene
