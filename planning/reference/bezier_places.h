#pragma once

#include <vector>

#include "roadbed/geometry/curves/quintic_bezier.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::planning::inline reference {

/// A place on a Bézier curve. Curvature and its rate by arc length are exact derivatives of it.
struct BezierPlace {
  geometry::Pose2 pose;
  double curvature_per_m, rate_per_m2;
};

/// `count` + 1 places at equal steps of the curve's parameter, ends included.
std::vector<BezierPlace> places_on(const geometry::QuinticBezier& curve, int count);

/// So many that those of the curve times `scale` are 0.2 m apart at most.
std::vector<BezierPlace> dense_places_on(const geometry::QuinticBezier& curve, double scale);

}  // namespace roadbed::planning::reference
