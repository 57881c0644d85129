#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::map::opendrive {

/// The unit vector of a heading.
inline Eigen::Vector2d unit(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

/// The clothoid that leads from one pose to another, as a piece of a plan view that begins at
/// `s_m`; a line or an arc where it is one (G1 Hermite interpolation, [Bertolazzi & Frego 2015,
/// doi:10.1002/mma.3114]).
/// @returns none if the poses are one place, or either heading is more than 70° off the chord.
std::optional<geometry::PlanPiece> clothoid_between(const geometry::Pose2& from,
                                                    const geometry::Pose2& to, double s_m);

}  // namespace roadbed::map::opendrive
