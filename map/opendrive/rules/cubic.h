#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "roadbed/geometry/curves/piecewise_cubic.h"

namespace roadbed::map::opendrive::rules {

/// Where a cubic is least, and how little that is.
struct LeastValue {
  double ds_m = 0.0, value = 0.0;
};

inline double value_at(const geometry::CubicRecord& cubic, double ds_m) {
  return cubic.a + ds_m * (cubic.b + ds_m * (cubic.c + ds_m * cubic.d));
}

inline double slope_at(const geometry::CubicRecord& cubic, double ds_m) {
  return cubic.b + ds_m * (2.0 * cubic.c + 3.0 * ds_m * cubic.d);
}

/// Least value over [0, length], exact: at an end, or where the derivative b + 2c·s + 3d·s² is 0.
inline LeastValue least_value(const geometry::CubicRecord& cubic, double length_m) {
  LeastValue least{0.0, cubic.a};
  const auto consider = [&](double ds_m) {
    if (!(ds_m > 0.0 && ds_m <= length_m)) return;
    const double value = value_at(cubic, ds_m);
    if (value < least.value) least = {ds_m, value};
  };
  consider(length_m);
  const double half_b = cubic.c, a = 3.0 * cubic.d, c = cubic.b;  // a·s² + 2·half_b·s + c = 0
  const double discriminant = half_b * half_b - a * c;
  if (discriminant < 0.0) return least;
  const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
  if (a != 0.0) consider(q / a);
  if (q != 0.0) consider(c / q);
  return least;
}

/// Greatest |slope| over [0, length], exact: at an end, or where 2c + 6d·s is 0.
inline LeastValue greatest_slope(const geometry::CubicRecord& cubic, double length_m) {
  LeastValue greatest{0.0, std::abs(cubic.b)};
  const double turn_m = cubic.d != 0.0 ? -cubic.c / (3.0 * cubic.d) : -1.0;
  for (const double ds_m : std::array<double, 2>{turn_m, length_m}) {
    if (!(ds_m > 0.0 && ds_m <= length_m)) continue;
    const double slope = std::abs(slope_at(cubic, ds_m));
    if (slope > greatest.value) greatest = {ds_m, slope};
  }
  return greatest;
}

}  // namespace roadbed::map::opendrive::rules
