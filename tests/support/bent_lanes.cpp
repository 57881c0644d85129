#include "roadbed/tests/support/bent_lanes.h"

#include <cmath>

namespace roadbed::tests {
namespace {

geometry::Pose2 along_arc(const geometry::Pose2& start, double curvature_per_m, double s_m) {
  const double turn = curvature_per_m * s_m;
  if (std::abs(turn) < 1e-9) {
    const Eigen::Vector2d at = start * Eigen::Vector2d(s_m, 0.0);
    return {at.x(), at.y(), start.heading_rad};
  }
  const Eigen::Vector2d at = start * Eigen::Vector2d(std::sin(turn) / curvature_per_m,
                                                     (1.0 - std::cos(turn)) / curvature_per_m);
  return {at.x(), at.y(), start.heading_rad + turn};
}

}  // namespace

map::LaneId add_arc_lane(MadeMap& made, map::RoadId road, const std::string& source_id,
                         const geometry::Pose2& start, double curvature_per_m, double length_m,
                         double width_m) {
  const int pieces = std::max(1, static_cast<int>(std::ceil(length_m / 0.5)));
  std::vector<Eigen::Vector2d> left, right;
  for (int i = 0; i <= pieces; ++i) {
    const geometry::Pose2 at = along_arc(start, curvature_per_m, length_m * i / pieces);
    left.push_back(at * Eigen::Vector2d(0.0, 0.5 * width_m));
    right.push_back(at * Eigen::Vector2d(0.0, -0.5 * width_m));
  }
  return made.add_lane(road, source_id, left, right);
}

MadeMap random_arc_lanes(std::mt19937& random, int count, double extent_m) {
  std::uniform_real_distribution<double> place(-extent_m, extent_m), heading(-3.0, 3.0),
      curvature(-0.06, 0.06), length(5.0, 40.0), width(2.5, 4.5);
  MadeMap made;
  const map::RoadId road = made.add_road("1");
  for (int i = 0; i < count; ++i) {
    const geometry::Pose2 start{place(random), place(random), heading(random)};
    const double curvature_per_m = curvature(random), length_m = length(random);
    add_arc_lane(made, road, std::to_string(-1 - i), start, curvature_per_m, length_m,
                 width(random));
  }
  return made;
}

}  // namespace roadbed::tests
