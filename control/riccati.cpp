#include "roadbed/control/riccati.h"

#include <Eigen/Dense>
#include <stdexcept>

namespace roadbed::control {
namespace {

constexpr int kMostSteps = 60;
constexpr double kRankTolerance = 1e-10;

void check_shapes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, const Eigen::MatrixXd& Q,
                  const Eigen::MatrixXd& R) {
  const bool fit = A.rows() > 0 && A.rows() == A.cols() && B.rows() == A.rows() && B.cols() > 0 &&
                   Q.rows() == A.rows() && Q.cols() == A.rows() && R.rows() == B.cols() &&
                   R.cols() == B.cols();
  if (!fit) throw std::invalid_argument("solve_riccati: the shapes of A, B, Q and R do not fit");
  if (!A.allFinite() || !B.allFinite() || !Q.allFinite() || !R.allFinite()) {
    throw std::invalid_argument("solve_riccati: A, B, Q and R must be finite");
  }
}

double riccati_residual(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                        const Eigen::MatrixXd& Q, const Eigen::MatrixXd& R,
                        const Eigen::MatrixXd& P) {
  const Eigen::MatrixXd BtPA = B.transpose() * P * A;
  const Eigen::MatrixXd gain = (R + B.transpose() * P * B).ldlt().solve(BtPA);
  return (A.transpose() * P * A - BtPA.transpose() * gain + Q - P).cwiseAbs().maxCoeff();
}

}  // namespace

RiccatiSolution solve_riccati(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                              const Eigen::MatrixXd& Q, const Eigen::MatrixXd& R) {
  check_shapes(A, B, Q, R);
  const auto I = Eigen::MatrixXd::Identity(A.rows(), A.rows());
  Eigen::MatrixXd A_k = A;
  Eigen::MatrixXd G_k = B * R.ldlt().solve(B.transpose());
  Eigen::MatrixXd H_k = Q;
  RiccatiSolution found;
  while (found.steps < kMostSteps && !found.converged) {
    const Eigen::PartialPivLU<Eigen::MatrixXd> W(I + G_k * H_k);
    const Eigen::MatrixXd W_A = W.solve(A_k);
    const Eigen::MatrixXd more = A_k.transpose() * H_k * W_A;
    G_k += A_k * W.solve(G_k) * A_k.transpose();
    H_k += 0.5 * (more + more.transpose());
    A_k = A_k * W_A;
    ++found.steps;
    if (!H_k.allFinite()) break;
    found.converged = more.cwiseAbs().maxCoeff() <= 1e-15 * H_k.cwiseAbs().maxCoeff();
  }
  found.P = H_k;
  found.residual = riccati_residual(A, B, Q, R, H_k);
  return found;
}

int controllability_rank(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  const Eigen::Index n = A.rows();
  Eigen::MatrixXd reach(n, n * B.cols());
  Eigen::MatrixXd column = B;
  for (Eigen::Index k = 0; k < n; ++k) {
    reach.middleCols(k * B.cols(), B.cols()) = column;
    column = A * column;
  }
  for (Eigen::Index row = 0; row < n; ++row) {
    const double largest = reach.row(row).cwiseAbs().maxCoeff();
    if (largest > 0.0) reach.row(row) /= largest;
  }
  Eigen::JacobiSVD<Eigen::MatrixXd> decomposition(reach);
  decomposition.setThreshold(kRankTolerance);
  return static_cast<int>(decomposition.rank());
}

int observability_rank(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C) {
  return controllability_rank(A.transpose(), C.transpose());
}

}  // namespace roadbed::control
