#pragma once

#include <Eigen/Core>
#include <array>

#include "roadbed/geometry/curves/curve_table.h"

namespace roadbed::geometry::inline curves {

/// Gaps between the control points on each leg of a corner, from the leg towards the corner:
/// |P0 P1|, |P1 P2| and |P2 corner| (paper's d1, d2, d3; it uses 3, 3 and 8 m in Fig. 4).
///
///     ──●─────●─────●────────────┐ corner w2
///       P0 d1 P1 d2 P2     d3
///
/// Equal first two gaps on a straight leg make the second derivative vanish at the ends, so that
/// the curve joins the legs with zero curvature.
struct CornerGaps {
  double first_m = 3.0;
  double second_m = 3.0;
  double corner_m = 8.0;

  double total_m() const { return first_m + second_m + corner_m; }
};

/// The paper's gaps of Fig. 4, and round ones of the same length whose curvature changes little at
/// a right angle: peak 0.113 1/m and 0.0154 1/m² instead of 0.130 1/m and 0.142 1/m². It changes
/// least with 5.17, 5.17 and 3.66 m: 0.123 1/m and 0.0127 1/m².
inline constexpr CornerGaps kPaperGaps{3.0, 3.0, 8.0};
inline constexpr CornerGaps kGentleGaps{5.0, 5.0, 4.0};

/// The same proportions over another total length.
CornerGaps scaled_to(const CornerGaps& gaps, double total_m);

/// Bézier curve of degree five, B(t) = Σⱼ C(5,j) (1−t)^(5−j) t^j Pⱼ for t in [0, 1] [paper eq. 6].
class QuinticBezier {
 public:
  explicit QuinticBezier(const std::array<Eigen::Vector2d, 6>& control_points)
      : control_points_(control_points) {}

  /// Rounds the corner of the legs w1→w2 and w2→w3 [paper eq. 8–11, where eq. 9 needs `·` for its
  /// second `+`].
  /// @throws std::invalid_argument if a leg is shorter than the gaps together or a gap is not
  ///         positive.
  static QuinticBezier corner(const Eigen::Vector2d& w1, const Eigen::Vector2d& w2,
                              const Eigen::Vector2d& w3, const CornerGaps& gaps = kPaperGaps);

  /// From one place of a curve to another one, with the position, heading and curvature of both, as
  /// a corner between curved legs asks for. The first two gaps of each leg are equal.
  /// @throws std::invalid_argument if a gap is not positive.
  static QuinticBezier joining(const CurvePoint& from, double from_gap_m, const CurvePoint& to,
                               double to_gap_m);

  const std::array<Eigen::Vector2d, 6>& control_points() const { return control_points_; }

  Eigen::Vector2d at(double t) const { return derivative(t, 0); }

  /// Derivative with respect to t, of order 0 to 5; higher ones are zero.
  Eigen::Vector2d derivative(double t, int order) const;

  /// Curvature [1/m], positive to the left.
  double curvature_per_m(double t) const;

  double length_m() const;

 private:
  std::array<Eigen::Vector2d, 6> control_points_;
};

}  // namespace roadbed::geometry::curves
