#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "roadbed/geometry/curves/smooth_curve.h"

namespace roadbed::geometry::inline curves {

/// A stretch of the line through the points, by its length, where they may move farther.
struct WiderStretch {
  double from_m, to_m, tolerance_m;
};

struct FitOptions {
  double knot_distance_m = 1.0;
  double scale_m = 3.0;              ///< detail shorter than this is smoothed away; ≤ 4 knots
  double tolerance_m = 0.3;          ///< largest move of the points, sideways
  double max_curvature_per_m = 0.2;  ///< a curve that bends more is tried at smaller scales too
  std::vector<WiderStretch> wider = {};
};

struct FittedCurve {
  SmoothCurve curve;
  double largest_move_m = 0.0;        ///< of the line through the points, to the curve
  double peak_curvature_per_m = 0.0;  ///< |κ|, at steps of a quarter knot distance
};

/// Smooth curve p(u) beside measured points q, a smoothing spline: of all curves the one of least
///
///     Σ wᵢ (nᵢ·(p(uᵢ) − qᵢ))² Δu  +  Σ (tᵢ·(p(uᵢ) − qᵢ))² Δu  +  scale⁶ ∫ |p‴(u)|² du
///
/// with tangents tᵢ and normals nᵢ of the line. The uᵢ are those of the feet of the qᵢ on the curve
/// before, so that u stays in proportion to arc length and p‴ to the curvature rate. The weights
/// wᵢ are 1 at first, less in wider stretches, and grow where a point moves by more than its
/// tolerance: what is left is about the least curvature rate that the tolerance permits. O(N) per
/// iteration, about 1 ms for 50 m.
/// @param points  about `knot_distance_m` / 2 apart or nearer; between them lines are straight.
/// @throws std::invalid_argument if there are fewer than two distinct points, one is not finite or
///         an option is out of range.
FittedCurve fit_curve(std::span<const Eigen::Vector2d> points, const FitOptions& options = {});

}  // namespace roadbed::geometry::curves
