#pragma once

#include <cmath>
#include <numbers>

namespace roadbed::geometry::inline primitives {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

/// The same direction in (−π, π].
inline double wrap_angle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? wrapped + 2.0 * std::numbers::pi : wrapped;
}

}  // namespace roadbed::geometry::primitives
