#include "roadbed/geometry/motion/body_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace roadbed::geometry::inline motion {

Rectangle BodyPart::core_at(const Pose2& pose) const {
  const Eigen::Vector2d axis(std::cos(pose.heading_rad), std::sin(pose.heading_rad));
  const Eigen::Vector2d left(-axis.y(), axis.x()), middle = middle_in_vehicle();
  return {.centre = pose.position() + middle.x() * axis + middle.y() * left,
          .axis = axis,
          .half_length_m = 0.5 * length_m(),
          .half_width_m = 0.5 * width_m()};
}

Rectangle BodyPart::box_at(const Pose2& pose) const {
  Rectangle box = core_at(pose);
  box.half_length_m += radius_m;
  box.half_width_m += radius_m;
  return box;
}

double BodyPart::circumradius_m() const {
  return 0.5 * std::hypot(length_m(), width_m()) + radius_m;
}

double BodyPart::reach_m() const {
  return std::hypot(std::max(std::abs(rear_m), std::abs(front_m)),
                    std::max(std::abs(right_m), std::abs(left_m))) +
         radius_m;
}

Ring BodyPart::outline_at(const Pose2& pose) const {
  const Rectangle core = core_at(pose);
  if (!is_circle()) {
    const auto corners = core.corners();
    return {corners.begin(), corners.end()};
  }
  constexpr int count = 32;
  Ring ring;
  for (int i = 0; i < count; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / count;
    ring.push_back(core.centre +
                   radius_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
  }
  return ring;
}

void BodyPart::check() const {
  const auto demand = [this](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument(fmt::format("{}: {}", name, rule));
  };
  for (const double measure : {rear_m, front_m, right_m, left_m, radius_m, from_height_m}) {
    demand(std::isfinite(measure), "every measure must be finite");
  }
  demand(radius_m >= 0.0, "the radius must be at least 0");
  demand(is_circle() ? rear_m == front_m && right_m == left_m : rear_m < front_m,
         "the rear must lie behind the front, and a circle has one middle");
  demand(is_circle() || right_m < left_m, "the right must lie to the right of the left");
  demand(from_height_m < to_height_m && std::isfinite(to_height_m),
         "it must begin lower than it ends");
}

BodyPart body_of(const VehicleShape& shape, double from_height_m) {
  shape.check();
  return {.rear_m = -shape.rear_overhang_m,
          .front_m = shape.front_m(),
          .right_m = -0.5 * shape.width_m,
          .left_m = 0.5 * shape.width_m,
          .from_height_m = from_height_m,
          .to_height_m = shape.height_m};
}

double box_area_m2(const BodyPart& part) {
  const double around_m = 2.0 * part.radius_m;
  return (part.length_m() + around_m) * (part.width_m() + around_m);
}

BodyPart inflated(BodyPart part, double margin_m) {
  if (part.is_circle()) {
    part.radius_m += margin_m;
    return part;
  }
  part.rear_m -= margin_m;
  part.front_m += margin_m;
  part.right_m -= margin_m;
  part.left_m += margin_m;
  return part;
}

}  // namespace roadbed::geometry::motion
