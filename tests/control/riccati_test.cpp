#include "roadbed/control/riccati.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>
#include <stdexcept>

namespace roadbed::control {
namespace {

struct Problem {
  Eigen::MatrixXd A, B, Q, R;
};

Eigen::MatrixXd random_matrix(int rows, int columns, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

Problem random_problem(std::mt19937& random) {
  const int n = 1 + static_cast<int>(random() % 5), m = 1 + static_cast<int>(random() % 2);
  const Eigen::MatrixXd q = random_matrix(n, n, random), r = random_matrix(m, m, random);
  return {.A = 0.7 * random_matrix(n, n, random),
          .B = random_matrix(n, m, random),
          .Q = q * q.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n),
          .R = r * r.transpose() + 0.1 * Eigen::MatrixXd::Identity(m, m)};
}

// The definition: cost-to-go of one step more, until it settles.
Eigen::MatrixXd iterate_values(const Problem& p) {
  Eigen::MatrixXd P = p.Q;
  for (int k = 0; k < 20'000; ++k) {
    const Eigen::MatrixXd BtPA = p.B.transpose() * P * p.A;
    const Eigen::MatrixXd next =
        p.A.transpose() * P * p.A -
        BtPA.transpose() * (p.R + p.B.transpose() * P * p.B).inverse() * BtPA + p.Q;
    const double change = (next - P).cwiseAbs().maxCoeff();
    P = 0.5 * (next + next.transpose());
    if (change < 1e-15) break;
  }
  return P;
}

TEST(Riccati, DoublingFindsWhatValueIterationFinds) {
  std::mt19937 random(20261121);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const Problem p = random_problem(random);
    const RiccatiSolution found = solve_riccati(p.A, p.B, p.Q, p.R);
    const Eigen::MatrixXd expected = iterate_values(p);
    const double scale = expected.cwiseAbs().maxCoeff();
    ASSERT_TRUE(found.converged);
    EXPECT_LT((found.P - expected).cwiseAbs().maxCoeff(), 1e-9 * scale);
    EXPECT_LT(found.residual, 1e-9 * scale);
  }
}

TEST(Riccati, ClosedLoopIsStable) {
  std::mt19937 random(7);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const Problem p = random_problem(random);
    const Eigen::MatrixXd P = solve_riccati(p.A, p.B, p.Q, p.R).P;
    const Eigen::MatrixXd K =
        (p.R + p.B.transpose() * P * p.B).ldlt().solve(p.B.transpose() * P * p.A);
    EXPECT_LT((p.A - p.B * K).eigenvalues().cwiseAbs().maxCoeff(), 1.0);
  }
}

TEST(Riccati, ScalarCaseIsTheRootOfItsQuadratic) {
  // p = a²p − a²p²b²/(r + b²p) + q  ⇔  b²p² + (r − a²r − b²q) p − q r = 0.
  const double a = 1.2, b = 0.5, q = 2.0, r = 3.0;
  const double linear = r - a * a * r - b * b * q;
  const double p = (-linear + std::sqrt(linear * linear + 4 * b * b * q * r)) / (2 * b * b);
  const auto one = [](double value) { return Eigen::MatrixXd::Constant(1, 1, value); };
  EXPECT_NEAR(solve_riccati(one(a), one(b), one(q), one(r)).P(0, 0), p, 1e-11);
}

TEST(Riccati, MatricesThatDoNotFitAreRefused) {
  const Eigen::MatrixXd square = Eigen::MatrixXd::Identity(3, 3);
  const Eigen::MatrixXd column = Eigen::MatrixXd::Ones(3, 1);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  EXPECT_THROW(solve_riccati(square, Eigen::MatrixXd::Ones(2, 1), square, one),
               std::invalid_argument);
  EXPECT_THROW(solve_riccati(square, column, square, square), std::invalid_argument);
  EXPECT_THROW(
      solve_riccati(square, column, square, one * std::numeric_limits<double>::quiet_NaN()),
      std::invalid_argument);
}

TEST(Riccati, RanksSeeWhatInputAndOutputReach) {
  Eigen::Matrix3d chain;
  chain << 1, 0.1, 0, 0, 1, 0.1, 0, 0, 1;
  EXPECT_EQ(controllability_rank(chain, Eigen::Vector3d(0, 0, 1)), 3);
  EXPECT_EQ(controllability_rank(chain, Eigen::Vector3d(0, 1, 0)), 2);
  EXPECT_EQ(controllability_rank(chain, Eigen::Vector3d(0, 0, 0)), 0);
  EXPECT_EQ(observability_rank(chain, Eigen::RowVector3d(1, 0, 0)), 3);
  EXPECT_EQ(observability_rank(chain, Eigen::RowVector3d(0, 1, 0)), 2);
}

}  // namespace
}  // namespace roadbed::control
