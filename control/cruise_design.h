#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "roadbed/geometry/motion/longitudinal.h"

namespace roadbed::control {

/// Parameters of paper section 3.3.
struct CruiseOptions {
  double headway_s = geometry::kLongitudinal.headway_s;                ///< τ_h
  double standstill_gap_m = geometry::kLongitudinal.standstill_gap_m;  ///< d_0
  double actuator_lag_s = geometry::kLongitudinal.actuator_lag_s;      ///< T_L
  double actuator_gain = geometry::kLongitudinal.actuator_gain;        ///< K_L
  double step_s = geometry::kLongitudinal.cycle_s;                     ///< T, sampling time
  /// ρ1 … ρ3, diagonal of Q (paper eq. 29). ρ3, of the own acceleration, is 0 because r counts it
  /// already: a_f is u behind the lag. ρ3 = 1 brings the string gain of the whole loop from 0.9972
  /// to 0.9978, and drives settle with four small swings where there are none.
  Eigen::Vector3d state_weights{1.0, 1.0, 0.0};
  double input_weight = 1.0;  ///< r
  Eigen::Vector3d measurement_noise_variance{0.25, 0.04, 0.01};
  double lead_acceleration_variance = 1.0;  ///< of a_p, the disturbance [m²/s⁴]
  double actuator_noise_variance = 1e-4;    ///< added to a_f in each step [m²/s⁴]
  double max_command_mps2 = geometry::kLongitudinal.max_command_mps2;
  double max_jerk_mps3 = geometry::kLongitudinal.max_jerk_mps3;
  double bridged_s = 0.5;  ///< a lead that is not measured for so long is still followed
};

/// x_{k+1} = A x_k + B u_k + G a_p, x = [d_desire − d, v_p − v_f, a_f] (paper eq. 27–28).
struct CruiseModel {
  Eigen::Matrix3d A;
  Eigen::Vector3d B;
  Eigen::Vector3d G;  ///< of the lead's acceleration
};

/// Exact zero-order hold of the paper's continuous model, disturbance included:
/// exp([A B Γ; 0 0 0] T) = [A_d B_d Γ_d; 0 I].
/// @throws std::invalid_argument if a time is not positive and finite.
CruiseModel discretise(const CruiseOptions& options);

/// u = −K x̂; x̂ from a stationary Kalman filter with gain L, x̂ ← x̂ + L (y − x̂), y all three states.
struct CruiseDesign {
  CruiseModel model;
  Eigen::RowVector3d K;
  Eigen::Matrix3d P;                               ///< cost-to-go
  Eigen::Matrix3d L;                               ///< filter form (not A·L, the prediction form)
  Eigen::Matrix3d S;                               ///< covariance of the innovation y − x̂
  Eigen::RowVector2d K_speed;                      ///< set-speed hold, on [v_set − v, a_f]
  double riccati_residual = 0.0;                   ///< largest absolute entry, of P
  double kalman_residual = 0.0;                    ///< the same of the filter's equation
  std::vector<std::complex<double>> poles;         ///< of A − B K
  std::vector<std::complex<double>> filter_poles;  ///< of A (I − L)
};

/// Linear-quadratic gain and Kalman gain for the model (paper eq. 29–30, Fig. 10).
/// @throws std::invalid_argument if a weight or variance is unusable, or the pair is not
///         controllable or observable; the message says which and the rank found.
CruiseDesign design_cruise(const CruiseOptions& options);

/// Largest gain from a lead to its follower, over frequency.
struct StringGain {
  double gain = 0.0;  ///< 1 or less: a disturbance does not grow down a platoon
  double at_radps = 0.0;
};

/// |a_f / a_p| of the sampled closed loop u = −K x, without filter, delay and saturation, from
/// 0.001 rad/s to the Nyquist frequency.
StringGain string_gain(const CruiseDesign& design, double step_s);

/// |v_f / v_p| of the sampled loop as it is run, from 0.01 to 1 Hz: u = −K x̂ from the Kalman
/// filter, which does not know the lead's acceleration, and reaches the actuator `delay_steps`
/// late. Without saturation.
/// @throws std::invalid_argument if the delay is negative.
StringGain loop_string_gain(const CruiseDesign& design, double step_s, int delay_steps);

}  // namespace roadbed::control
