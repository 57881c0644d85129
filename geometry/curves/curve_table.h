#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace roadbed::geometry::inline curves {

/// A place on a smooth curve. Derivatives are with respect to arc length.
struct CurvePoint {
  double s_m = 0.0;
  Eigen::Vector2d position{0, 0};
  double heading_rad = 0.0;                 ///< continuous along the curve, not wrapped
  std::array<double, 5> curvature_per_m{};  ///< κ, κ′, κ″, κ‴, κ⁗ [1/m … 1/m⁵], + to the left
};

/// A curve between given points of it, as polynomials of arc length: κ of degree nine, which meets
/// κ … κ⁗ at both ends of a piece, the heading its integral, x and y of degree seven, which meet
/// position, direction, κ and κ′. All of them are continuous. Immutable.
class CurveTable {
 public:
  CurveTable() = default;

  /// @param nodes  at least two, of increasing s from 0. Where the curve is analytic between two of
  ///               them that are a quarter of a metre apart, the table is off by rounding only.
  explicit CurveTable(const std::vector<CurvePoint>& nodes);

  /// Point at arc length `s_m`, which is clamped. O(1), under 100 ns.
  CurvePoint at(double s_m) const;

 private:
  struct Piece {
    double s_m, heading_rad;
    std::array<double, 10> curvature;  // by ascending power of the arc length in the piece
    std::array<double, 8> x, y;
  };

  static Piece piece_between(const CurvePoint& from, const CurvePoint& to);
  const Piece& piece_at(double s_m) const;

  double length_m_ = 0.0, buckets_per_m_ = 0.0;
  std::vector<Piece> pieces_;
  std::vector<std::size_t> first_in_bucket_;  // the piece that holds the start of each bucket
};

}  // namespace roadbed::geometry::curves
