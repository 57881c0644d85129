#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace roadbed::geometry::inline curves {

/// Symmetric matrix that is zero away from the diagonal; only the lower half is kept.
class BandMatrix {
 public:
  /// @param bandwidth  number of diagonals below the main one.
  BandMatrix(std::size_t size, std::size_t bandwidth)
      : size_(size), width_(bandwidth + 1), values_(size * width_, 0.0) {}

  std::size_t size() const { return size_; }

  /// Entry of the lower half: row ≥ column ≥ row − bandwidth.
  double& at(std::size_t row, std::size_t column) {
    return values_[row * width_ + column + width_ - 1 - row];
  }

  /// x of `matrix x = right` by Cholesky's factors; none if the matrix is not positive definite to
  /// the digits that there are. O(N · bandwidth²).
  static std::optional<std::vector<double>> solve(BandMatrix matrix, std::vector<double> right);

 private:
  std::size_t first_column(std::size_t row) const {
    return row < width_ - 1 ? 0 : row - (width_ - 1);
  }
  bool factorise();

  std::size_t size_, width_;
  std::vector<double> values_;
};

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
