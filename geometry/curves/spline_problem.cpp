#include "roadbed/geometry/curves/spline_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "roadbed/geometry/curves/quadrature.h"
#include "roadbed/geometry/curves/smooth_curve.h"

namespace roadbed::geometry::inline curves {
namespace {

using Basis = std::array<double, kSplineOrder>;

Basis basis_at(double t) {
  Basis values;
  for (std::size_t j = 0; j < kSplineOrder; ++j) values[j] = evaluate(cardinal_basis()[j], t);
  return values;
}

// ∫ bᵢ‴ bⱼ‴ dt over one span; the integrand is a polynomial of degree 8, so this is exact.
std::array<Basis, kSplineOrder> make_roughness() {
  std::array<Basis, kSplineOrder> values{};
  for (std::size_t i = 0; i < kSplineOrder; ++i) {
    for (std::size_t j = 0; j < kSplineOrder; ++j) {
      const auto both = [&](double t) {
        return evaluate(cardinal_basis()[i], t, 3) * evaluate(cardinal_basis()[j], t, 3);
      };
      values[i][j] = integrate(both, 0.0, 1.0);
    }
  }
  return values;
}

const std::array<Basis, kSplineOrder>& roughness() {
  static const auto table = make_roughness();
  return table;
}

}  // namespace

bool BandMatrix::factorise() {
  for (std::size_t row = 0; row < size_; ++row) {
    for (std::size_t column = first_column(row); column <= row; ++column) {
      double sum = at(row, column);
      const std::size_t from = std::max(first_column(row), first_column(column));
      for (std::size_t k = from; k < column; ++k) sum -= at(row, k) * at(column, k);
      if (column < row) {
        at(row, column) = sum / at(column, column);
      } else if (sum > 0.0) {
        at(row, row) = std::sqrt(sum);
      } else {
        return false;
      }
    }
  }
  return true;
}

std::optional<std::vector<double>> BandMatrix::solve(BandMatrix matrix, std::vector<double> right) {
  if (!matrix.factorise()) return {};
  for (std::size_t row = 0; row < matrix.size_; ++row) {
    for (std::size_t k = matrix.first_column(row); k < row; ++k) {
      right[row] -= matrix.at(row, k) * right[k];
    }
    right[row] /= matrix.at(row, row);
  }
  for (std::size_t row = matrix.size_; row-- > 0;) {
    right[row] /= matrix.at(row, row);
    for (std::size_t k = matrix.first_column(row); k < row; ++k) {
      right[k] -= matrix.at(row, k) * right[row];
    }
  }
  return right;
}

SplineProblem::SplineProblem(std::vector<Eigen::Vector2d> control_points, double knot_distance)
    : control_points_(std::move(control_points)),
      knot_distance_(knot_distance),
      spans_(control_points_.size() - kSplineDegree),
      matrix_(2 * control_points_.size(), 2 * kSplineOrder - 1),
      right_(matrix_.size(), 0.0) {}

void SplineProblem::smooth(double factor) {
  const double scaled = factor / std::pow(knot_distance_, 5);
  for (std::size_t k = 0; k < spans_; ++k) {
    for (std::size_t i = 0; i < kSplineOrder; ++i) {
      Eigen::Vector2d slope(0.0, 0.0);
      for (std::size_t j = 0; j < kSplineOrder; ++j) {
        const double entry = scaled * roughness()[i][j];
        slope += entry * (control_points_[k + j] - control_points_[k]);
        if (j > i) continue;
        matrix_.at(2 * (k + i), 2 * (k + j)) += entry;
        matrix_.at(2 * (k + i) + 1, 2 * (k + j) + 1) += entry;
      }
      right_[2 * (k + i)] -= slope.x();
      right_[2 * (k + i) + 1] -= slope.y();
    }
  }
}

void SplineProblem::attract(double u, const Eigen::Vector2d& point, const Eigen::Matrix2d& weight) {
  const double index =
      std::clamp(std::floor(u / knot_distance_), 0.0, static_cast<double>(spans_ - 1));
  const Basis basis = basis_at(u / knot_distance_ - index);
  const auto span = static_cast<std::size_t>(index);
  Eigen::Vector2d missing(0.0, 0.0);  // the basis adds up to one
  for (std::size_t j = 0; j < kSplineOrder; ++j) {
    missing += basis[j] * (point - control_points_[span + j]);
  }
  const Eigen::Vector2d pull = weight * missing;
  const std::size_t first = 2 * span;
  for (std::size_t row = 0; row < 2 * kSplineOrder; ++row) {
    const auto axis = static_cast<Eigen::Index>(row % 2);
    right_[first + row] += basis[row / 2] * pull(axis);
    for (std::size_t column = 0; column <= row; ++column) {
      matrix_.at(first + row, first + column) +=
          basis[row / 2] * basis[column / 2] * weight(axis, static_cast<Eigen::Index>(column % 2));
    }
  }
}

std::optional<std::vector<Eigen::Vector2d>> SplineProblem::solve() && {
  const auto moves = BandMatrix::solve(std::move(matrix_), std::move(right_));
  if (!moves) return {};
  for (std::size_t i = 0; i < control_points_.size(); ++i) {
    control_points_[i] += Eigen::Vector2d((*moves)[2 * i], (*moves)[2 * i + 1]);
  }
  return std::move(control_points_);
}

}  // namespace roadbed::geometry::curves
