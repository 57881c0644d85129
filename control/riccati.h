#pragma once

#include <Eigen/Core>

namespace roadbed::control {

/// Cost-to-go of the discrete linear-quadratic problem, and how well it was found.
struct RiccatiSolution {
  Eigen::MatrixXd P;      ///< n×n, symmetric
  double residual = 0.0;  ///< largest absolute entry of the equation's two sides' difference
  int steps = 0;          ///< doublings taken
  bool converged = false;
};

/// Stabilising solution of the discrete algebraic Riccati equation
///
///     P = AᵀPA − AᵀPB (R + BᵀPB)⁻¹ BᵀPA + Q                        (30, corrected)
///
/// by structured doubling [Chu, Fan, Lin, Wang 2004, doi:10.1080/00207170410001714988]: step k
/// holds the cost-to-go of 2^k sampling periods, so that about ten steps do the work of a thousand
/// value iterations. (The paper prints the continuous equation with a wrong sign.)
///
/// @param A  n×n.  @param B  n×m.  @param Q  n×n, symmetric, positive semi-definite.
/// @param R  m×m, symmetric, positive definite.
/// @throws std::invalid_argument if the shapes do not fit or a number is not finite.
RiccatiSolution solve_riccati(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                              const Eigen::MatrixXd& Q, const Eigen::MatrixXd& R);

/// Rank of the controllability matrix [B, AB, …, Aⁿ⁻¹B]. Each row is scaled to its largest entry
/// first, so that a short sampling period does not look like a lost rank.
int controllability_rank(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// Rank of the observability matrix [C; CA; …; CAⁿ⁻¹], by duality.
int observability_rank(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C);

}  // namespace roadbed::control
