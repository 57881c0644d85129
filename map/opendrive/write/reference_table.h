#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "roadbed/geometry/curves/plan_view.h"

namespace roadbed::map::opendrive {

/// Curvature where a line, arc or clothoid begins and ends.
/// @throws std::invalid_argument for any other curve.
std::pair<double, double> curvatures_per_m(const geometry::PlanCurve& curve);

/// A reference line of lines, arcs and clothoids as polynomials of s: places beside it are asked
/// for some thousand times, and a sine is the dearest part of an answer.
///
/// With curvature κ(s) = K + R (s − m) about the middle m of a cell, the direction u = exp(i θ) has
/// u′ = i κ u, and so the power series (n + 1) uₙ₊₁ = i (K uₙ + R uₙ₋₁). Cells are so short that
/// nine terms leave out less than 1e-8 (m, rad).
class ReferenceTable {
 public:
  struct Point {
    Eigen::Vector2d in_map, along;  ///< the place, and the unit vector of the heading
    double curvature_per_m;

    double heading_rad() const { return std::atan2(along.y(), along.x()); }
    Eigen::Vector2d beside(double t_m) const {
      return in_map + t_m * Eigen::Vector2d(-along.y(), along.x());
    }
  };

  /// @param pieces  by growing s from 0, one or more.
  /// @throws std::invalid_argument if one is no line, arc or clothoid.
  explicit ReferenceTable(std::span<const geometry::PlanPiece> pieces);

  double end_s_m() const { return end_s_m_; }

  /// Where a piece ends and the next one begins strictly inside a range, nearest to its middle.
  std::optional<double> joint_between(double from_m, double to_m) const;

  /// Within [0, end_s_m()]. O(1).
  Point at(double s_m) const;

 private:
  static constexpr std::size_t kTerms = 9;

  struct Cell {
    double from_m, middle_m, curvature_per_m, rate_per_m2;
    Eigen::Vector2d in_map;  // in the middle
    std::array<Eigen::Vector2d, kTerms> along;
  };

  void add_piece(const geometry::PlanPiece& piece);

  double end_s_m_ = 0.0;
  std::vector<double> joints_m_;
  std::vector<Cell> cells_;
  std::vector<std::size_t> cell_of_bucket_;  // that the start of each lies in
};

}  // namespace roadbed::map::opendrive
