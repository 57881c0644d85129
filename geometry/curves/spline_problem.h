#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "roadbed/geometry/curves/band_matrix.h"

namespace roadbed::geometry::inline curves {

/// Normal equations for the control points of a uniform B-spline of degree seven that passes near
/// points and bends little. Unknowns are x and y of each control point in turn, as moves from given
/// ones: these are small, so that few digits are lost however far away the coordinates are.
class SplineProblem {
 public:
  /// @param control_points  at least 8, about where the solution will be.
  SplineProblem(std::vector<Eigen::Vector2d> control_points, double knot_distance);

  /// Adds factor · ∫ |p‴(u)|² du.
  void smooth(double factor);

  /// Adds (p(u) − point)ᵀ weight (p(u) − point).
  void attract(double u, const Eigen::Vector2d& point, const Eigen::Matrix2d& weight);

  /// The control points of least cost; none if the weights span more than the digits that there
  /// are. The problem is used up.
  std::optional<std::vector<Eigen::Vector2d>> solve() &&;

 private:
  std::vector<Eigen::Vector2d> control_points_;
  double knot_distance_;
  std::size_t spans_;
  BandMatrix matrix_;
  std::vector<double> right_;
};

}  // namespace roadbed::geometry::curves
