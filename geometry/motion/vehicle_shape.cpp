#include "roadbed/geometry/motion/vehicle_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace roadbed::geometry::inline motion {

std::array<Eigen::Vector2d, 4> VehicleShape::corners_in_vehicle() const {
  const double rear = -rear_overhang_m, front = front_m(), side = 0.5 * width_m;
  return {Eigen::Vector2d{rear, -side}, {front, -side}, {front, side}, {rear, side}};
}

double VehicleShape::reach_m() const {
  return std::hypot(std::max(front_m(), rear_overhang_m), 0.5 * width_m);
}

void VehicleShape::check() const {
  const auto positive = [](const char* name, double value) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      throw std::invalid_argument(
          fmt::format("vehicle: {} must be finite and positive, got {}", name, value));
    }
  };
  positive("length_m", length_m);
  positive("width_m", width_m);
  positive("wheelbase_m", wheelbase_m);
  positive("height_m", height_m);
  positive("max_steering_rad", max_steering_rad);
  positive("max_steering_rate_radps", max_steering_rate_radps);
  if (!(rear_overhang_m >= 0.0) || rear_overhang_m + wheelbase_m > length_m) {
    throw std::invalid_argument(fmt::format(
        "vehicle: rear_overhang_m must be at least 0 and the front axle inside the body, got "
        "overhang {} m, wheelbase {} m, length {} m",
        rear_overhang_m, wheelbase_m, length_m));
  }
}

CoveringCircles covering_circles(const VehicleShape& shape, int count) {
  if (count < 1) {
    throw std::invalid_argument(
        fmt::format("covering_circles: count must be at least 1, got {}", count));
  }
  const double section_m = shape.length_m / count;
  CoveringCircles circles{.centres_x_m = {}, .radius_m = std::hypot(section_m, shape.width_m) / 2};
  for (int i = 0; i < count; ++i) {
    circles.centres_x_m.push_back(-shape.rear_overhang_m + (i + 0.5) * section_m);
  }
  return circles;
}

}  // namespace roadbed::geometry::motion
