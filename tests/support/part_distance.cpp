#include "roadbed/tests/support/part_distance.h"

#include <algorithm>

#include "roadbed/tests/support/brute_force_distance.h"

namespace roadbed::tests {

double part_to_cell_m(const geometry::BodyPart& part, double margin_m, const geometry::Pose2& pose,
                      const map::OccupancyCell& cell) {
  const Eigen::Vector2d middle = cell.centre_in_source.head<2>();
  const Eigen::Array2d half = Eigen::Array2d::Constant(0.5 * cell.size_m);
  if (part.radius_m > 0.0) {
    const Eigen::Array2d off = (pose * Eigen::Vector2d(part.front_m, part.left_m) - middle).array();
    const double away_m = (off.abs() - half).max(0.0).matrix().norm();
    return std::max(0.0, away_m - part.radius_m - margin_m);
  }
  const double rear = part.rear_m - margin_m, front = part.front_m + margin_m;
  const double right = part.right_m - margin_m, left = part.left_m + margin_m;
  const Quad body{pose * Eigen::Vector2d(rear, right), pose * Eigen::Vector2d(front, right),
                  pose * Eigen::Vector2d(front, left), pose * Eigen::Vector2d(rear, left)};
  return quad_distance(box_quad(middle.array() - half, middle.array() + half), body);
}

}  // namespace roadbed::tests
