#include "roadbed/planning/obstacles/recorded_obstacles.h"

#include <cmath>
#include <variant>

namespace roadbed::planning::inline obstacles {
namespace {

using map::commonroad::CircleShape;
using map::commonroad::PolygonShape;
using map::commonroad::RectangleShape;

void extend(Eigen::AlignedBox2d& box, const RectangleShape& shape) {
  for (const Eigen::Vector2d& corner : rectangle_of(shape).corners()) box.extend(corner);
}

void extend(Eigen::AlignedBox2d& box, const CircleShape& shape) {
  const Eigen::Vector2d reach(shape.radius_m, shape.radius_m);
  box.extend(shape.centre_m - reach);
  box.extend(shape.centre_m + reach);
}

void extend(Eigen::AlignedBox2d& box, const PolygonShape& shape) {
  for (const Eigen::Vector2d& corner : shape.corners_m) box.extend(corner);
}

}  // namespace

geometry::Rectangle rectangle_of(const RectangleShape& shape) {
  return {.centre = shape.centre_m,
          .axis = {std::cos(shape.heading_rad), std::sin(shape.heading_rad)},
          .half_length_m = 0.5 * shape.length_m,
          .half_width_m = 0.5 * shape.width_m};
}

Eigen::AlignedBox2d bounds_of(const map::commonroad::Shape& shape) {
  Eigen::AlignedBox2d box;
  for (const auto& part : shape) std::visit([&](const auto& form) { extend(box, form); }, part);
  return box;
}

}  // namespace roadbed::planning::obstacles
