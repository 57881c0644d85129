#include "roadbed/geometry/curves/quintic.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>
#include <stdexcept>

namespace roadbed::geometry {
namespace {

struct BoundaryProblem {
  BoundaryState start, end;
  double length;
};

std::vector<BoundaryProblem> random_boundary_problems(int count) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> value(-3.5, 3.5), slope(-0.3, 0.3), second(-0.1, 0.1),
      length(1.0, 60.0);
  std::vector<BoundaryProblem> problems;
  for (int i = 0; i < count; ++i) {
    problems.push_back({{value(random), slope(random), second(random)},
                        {value(random), slope(random), second(random)},
                        length(random)});
  }
  return problems;
}

// Paper eq. 13–18 as a 6×6 linear system.
Eigen::VectorXd solve_densely(const BoundaryProblem& p) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6, 6);
  for (int end = 0; end < 2; ++end) {
    const double l = end == 0 ? 0.0 : p.length;
    for (int j = 0; j < 6; ++j) {
      rows(3 * end, j) = std::pow(l, j);
      if (j >= 1) rows(3 * end + 1, j) = j * std::pow(l, j - 1);
      if (j >= 2) rows(3 * end + 2, j) = j * (j - 1) * std::pow(l, j - 2);
    }
  }
  Eigen::VectorXd right(6);
  right << p.start.value, p.start.slope, p.start.second, p.end.value, p.end.slope, p.end.second;
  return rows.fullPivLu().solve(right);
}

TEST(Quintic, MeetsBothBoundaryStates) {
  for (const BoundaryProblem& p : random_boundary_problems(1000)) {
    const Quintic quintic(p.start, p.end, p.length);
    const auto start = quintic.at(0.0), end = quintic.at(p.length);
    EXPECT_NEAR(start[0], p.start.value, 1e-12);
    EXPECT_NEAR(start[1], p.start.slope, 1e-12);
    EXPECT_NEAR(start[2], p.start.second, 1e-12);
    EXPECT_NEAR(end[0], p.end.value, 1e-10);
    EXPECT_NEAR(end[1], p.end.slope, 1e-10);
    EXPECT_NEAR(end[2], p.end.second, 1e-10);
  }
}

TEST(Quintic, AgreesWithADenseSolveOfThePapersSystem) {
  for (const BoundaryProblem& p : random_boundary_problems(1000)) {
    const Eigen::VectorXd expected = solve_densely(p);
    const Quintic quintic(p.start, p.end, p.length);
    for (int j = 0; j < 6; ++j) {
      const double scale = std::pow(p.length, j);  // compare in the unit of P
      EXPECT_NEAR(quintic.coefficients()[static_cast<std::size_t>(j)] * scale, expected[j] * scale,
                  1e-8);
    }
  }
}

TEST(Quintic, DerivativesAreThoseOfThePowers) {
  for (const BoundaryProblem& p : random_boundary_problems(100)) {
    const Quintic quintic(p.start, p.end, p.length);
    const double l = 0.37 * p.length;
    for (int order = 0; order < 6; ++order) {
      double expected = 0.0;
      for (int j = order; j < 6; ++j) {
        double factor = 1.0;
        for (int k = 0; k < order; ++k) factor *= j - k;
        expected +=
            factor * quintic.coefficients()[static_cast<std::size_t>(j)] * std::pow(l, j - order);
      }
      EXPECT_NEAR(quintic.at(l)[static_cast<std::size_t>(order)], expected, 1e-12);
    }
  }
}

TEST(Quintic, IsLinearInItsBoundaryStates) {
  for (const BoundaryProblem& p : random_boundary_problems(100)) {
    const Quintic from_start(p.start, {}, p.length), to_end({}, p.end, p.length),
        both(p.start, p.end, p.length);
    const double l = 0.6 * p.length;
    for (std::size_t order = 0; order < 6; ++order) {
      EXPECT_NEAR(from_start.at(l)[order] + to_end.at(l)[order], both.at(l)[order], 1e-12);
    }
  }
}

TEST(Quintic, RefusesALengthOrStateThatIsNotUsable) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Quintic({}, {}, 0.0), std::invalid_argument);
  EXPECT_THROW(Quintic({}, {}, -1.0), std::invalid_argument);
  EXPECT_THROW(Quintic({}, {}, nan), std::invalid_argument);
  EXPECT_THROW(Quintic({.value = nan}, {}, 1.0), std::invalid_argument);
  EXPECT_THROW(Quintic({}, {.slope = nan}, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::geometry
