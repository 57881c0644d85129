#include "roadbed/control/cruise_design.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>
#include <unsupported/Eigen/MatrixFunctions>

#include "roadbed/control/riccati.h"

namespace roadbed::control {
namespace {

void require(bool holds, const char* rule, double found) {
  if (!holds) throw std::invalid_argument(fmt::format("{}, got {}", rule, found));
}

void require_positive(double value, const char* rule) {
  require(value > 0.0 && std::isfinite(value), rule, value);
}

void require_not_negative(double value, const char* rule) {
  require(value >= 0.0 && std::isfinite(value), rule, value);
}

void check(const CruiseOptions& options) {
  require_not_negative(options.standstill_gap_m, "the standstill gap must not be negative");
  require_positive(options.input_weight, "the input weight r must be positive");
  require_positive(options.max_command_mps2, "the largest command must be positive");
  require_not_negative(options.lead_acceleration_variance, "a variance must not be negative");
  require_not_negative(options.actuator_noise_variance, "a variance must not be negative");
  for (const double weight : options.state_weights) {
    require_not_negative(weight, "the state weights must not be negative");
  }
  for (const double variance : options.measurement_noise_variance) {
    require_positive(variance, "the measurement variances must be positive");
  }
}

void require_rank(int rank, const char* what) {
  if (rank == 3) return;
  throw std::invalid_argument(fmt::format("{}: rank {} of 3", what, rank));
}

void check_ranks(const CruiseModel& model, const CruiseOptions& options) {
  require_rank(controllability_rank(model.A, model.B), "the pair (A, B) is not controllable");
  require_rank(observability_rank(model.A, Eigen::Matrix3d::Identity()),
               "the pair (A, C) is not observable");
  const Eigen::Matrix3d root_of_Q = options.state_weights.cwiseSqrt().asDiagonal();
  require_rank(observability_rank(model.A, root_of_Q),
               "the state weights do not see every state, the pair (A, √Q) is not observable");
}

RiccatiSolution solve_or_throw(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                               const Eigen::MatrixXd& Q, const Eigen::MatrixXd& R) {
  RiccatiSolution found = solve_riccati(A, B, Q, R);
  if (!found.converged) {
    throw std::invalid_argument(
        fmt::format("the Riccati equation was not solved in {} doublings", found.steps));
  }
  return found;
}

Eigen::RowVectorXd gain(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                        const Eigen::MatrixXd& P, double r) {
  const double denominator = r + (B.transpose() * P * B)(0, 0);
  return (B.transpose() * P * A) / denominator;
}

std::vector<std::complex<double>> eigenvalues(const Eigen::Matrix3d& matrix) {
  const Eigen::Vector3cd values = matrix.eigenvalues();
  return {values.begin(), values.end()};
}

/// The set speed in place of a lead: relative speed and acceleration, without the gap.
Eigen::RowVector2d design_speed_gain(const CruiseModel& model, const CruiseOptions& options) {
  const Eigen::Matrix2d A = model.A.bottomRightCorner<2, 2>();
  const Eigen::Vector2d B = model.B.tail<2>();
  const Eigen::Matrix2d Q = options.state_weights.tail<2>().asDiagonal();
  const Eigen::MatrixXd R = Eigen::MatrixXd::Constant(1, 1, options.input_weight);
  return gain(A, B, solve_or_throw(A, B, Q, R).P, options.input_weight);
}

void design_filter(const CruiseOptions& options, CruiseDesign& design) {
  const CruiseModel& model = design.model;
  const Eigen::Matrix3d noise_of_measurement = options.measurement_noise_variance.asDiagonal();
  Eigen::Matrix3d noise_of_process =
      options.lead_acceleration_variance * model.G * model.G.transpose();
  noise_of_process(2, 2) += options.actuator_noise_variance;
  const RiccatiSolution found = solve_or_throw(model.A.transpose(), Eigen::Matrix3d::Identity(),
                                               noise_of_process, noise_of_measurement);
  const Eigen::Matrix3d predicted = found.P;
  design.S = predicted + noise_of_measurement;
  design.L = design.S.ldlt().solve(predicted).transpose();
  design.kalman_residual = found.residual;
  design.filter_poles = eigenvalues(model.A * (Eigen::Matrix3d::Identity() - design.L));
}

}  // namespace

CruiseModel discretise(const CruiseOptions& options) {
  require_positive(options.step_s, "the sampling time must be positive");
  require_positive(options.headway_s, "the headway must be positive");
  require_positive(options.actuator_lag_s, "the actuator's lag must be positive");
  require_not_negative(options.actuator_gain, "the actuator's gain must not be negative");
  Eigen::Matrix<double, 5, 5> block = Eigen::Matrix<double, 5, 5>::Zero();
  block.topRows<3>() << 0, -1, options.headway_s, 0, 0,  //
      0, 0, -1, 0, 1,                                    //
      0, 0, -1 / options.actuator_lag_s, options.actuator_gain / options.actuator_lag_s, 0;
  const Eigen::Matrix<double, 5, 5> held = (block * options.step_s).exp();
  return {held.topLeftCorner<3, 3>(), held.block<3, 1>(0, 3), held.block<3, 1>(0, 4)};
}

CruiseDesign design_cruise(const CruiseOptions& options) {
  check(options);
  CruiseDesign design;
  design.model = discretise(options);
  check_ranks(design.model, options);
  const auto& [A, B, G] = design.model;
  const Eigen::Matrix3d Q = options.state_weights.asDiagonal();
  const RiccatiSolution found =
      solve_or_throw(A, B, Q, Eigen::MatrixXd::Constant(1, 1, options.input_weight));
  design.P = found.P;
  design.K = gain(A, B, found.P, options.input_weight);
  design.riccati_residual = found.residual;
  design.poles = eigenvalues(A - B * design.K);
  design.K_speed = design_speed_gain(design.model, options);
  design_filter(options, design);
  return design;
}

}  // namespace roadbed::control
