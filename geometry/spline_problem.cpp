#include "roadbed/geometry/spline_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "roadbed/geometry/cardinal_spline.h"
#include "roadbed/geometry/quadrature.h"

namespace roadbed::geometry {
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

SplineProblem::SplineProblem(std::size_t spans, double knot_distance)
    : spans_(spans),
      knot_distance_(knot_distance),
      matrix_(2 * (spans + kSplineDegree), 2 * kSplineOrder - 1),
      right_(matrix_.size(), 0.0) {}

void SplineProblem::smooth(double factor) {
  const double scaled = factor / std::pow(knot_distance_, 5);
  for (std::size_t k = 0; k < spans_; ++k) {
    for (std::size_t i = 0; i < kSplineOrder; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const double entry = scaled * roughness()[i][j];
        matrix_.at(2 * (k + i), 2 * (k + j)) += entry;
        matrix_.at(2 * (k + i) + 1, 2 * (k + j) + 1) += entry;
      }
    }
  }
}

void SplineProblem::attract(double u, const Eigen::Vector2d& point, const Eigen::Matrix2d& weight) {
  const double index =
      std::clamp(std::floor(u / knot_distance_), 0.0, static_cast<double>(spans_ - 1));
  const Basis basis = basis_at(u / knot_distance_ - index);
  const Eigen::Vector2d pull = weight * point;
  const std::size_t first = 2 * static_cast<std::size_t>(index);
  for (std::size_t row = 0; row < 2 * kSplineOrder; ++row) {
    const auto axis = static_cast<Eigen::Index>(row % 2);
    right_[first + row] += basis[row / 2] * pull(axis);
    for (std::size_t column = 0; column <= row; ++column) {
      matrix_.at(first + row, first + column) +=
          basis[row / 2] * basis[column / 2] * weight(axis, static_cast<Eigen::Index>(column % 2));
    }
  }
}

std::vector<Eigen::Vector2d> SplineProblem::solve() && {
  const std::vector<double> flat = BandMatrix::solve(std::move(matrix_), std::move(right_));
  std::vector<Eigen::Vector2d> control_points;
  control_points.reserve(flat.size() / 2);
  for (std::size_t i = 0; i + 1 < flat.size(); i += 2) {
    control_points.emplace_back(flat[i], flat[i + 1]);
  }
  return control_points;
}

}  // namespace roadbed::geometry
