#pragma once

#include <array>
#include <memory>

#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::tests {

/// A line whose curvature is κ(s) = c0 + c1 s + … + c4 s⁴ for 0 ≤ s ≤ length; it starts at the
/// origin along x. Straight line, circle and clothoid are members. Corridor of constant width.
struct AnalyticLine {
  std::array<double, 5> curvature{};
  double left_m = 5.0;
  double right_m = 5.0;

  double heading_rad(double s_m) const;
  planning::ReferencePoint at(double s_m) const;
  planning::LineView view() const;
};

}  // namespace roadbed::tests
