#pragma once

#include <Eigen/Core>
#include <optional>

namespace roadbed::control {

/// Parameters of paper section 3.3.
struct CruiseOptions {
  double headway_s = 1.5;                        ///< τ_h
  double standstill_gap_m = 5.0;                 ///< d_0
  double actuator_lag_s = 0.45;                  ///< T_L
  double actuator_gain = 1.0;                    ///< K_L
  double step_s = 0.1;                           ///< T, sampling time
  Eigen::Vector3d state_weights{1.0, 1.0, 0.0};  ///< ρ1 … ρ3, diagonal of Q
  double input_weight = 1.0;                     ///< r
  Eigen::Vector3d measurement_noise_variance{0.25, 0.04, 0.01};
  double lead_acceleration_variance = 1.0;  ///< of a_p, the disturbance
  double max_command_mps2 = 0.25 * 9.81;    ///< paper: ±0.25 g
};

/// x = [d_desire − d, v_p − v_f, a_f], discretised exactly (zero-order hold).
struct CruiseModel {
  Eigen::Matrix3d A;
  Eigen::Vector3d B;
  Eigen::Vector3d G;  ///< of the lead's acceleration
};
CruiseModel discretise(const CruiseOptions& options);

/// u = −K x̂, x̂ from a stationary Kalman filter with gain L.
struct CruiseDesign {
  CruiseModel model;
  Eigen::RowVector3d K;
  Eigen::Matrix3d P;
  Eigen::Matrix3d L;
  double riccati_residual = 0.0;  ///< largest absolute entry
};

/// @throws std::invalid_argument if a weight or variance is unusable, or the pair is not
///         controllable or observable; the message says which and the rank found.
CruiseDesign design_cruise(const CruiseOptions& options);

/// What is known of the lead vehicle, measured with noise.
struct LeadMeasurement {
  double gap_m = 0.0;               ///< bumper to bumper
  double relative_speed_mps = 0.0;  ///< lead minus own
};

/// LQG cruise control: follows a lead at τ_h v + d_0, else holds a set speed. Call it every step_s.
class CruiseControl {
 public:
  explicit CruiseControl(const CruiseOptions& options);

  /// Desired acceleration [m/s²] within ±max_command.
  /// @param lead  none: no vehicle ahead is seen; the set speed is held.
  double update(double speed_mps, double acceleration_mps2, double set_speed_mps,
                const std::optional<LeadMeasurement>& lead);

  const CruiseDesign& design() const { return design_; }

 private:
  CruiseOptions options_;
  CruiseDesign design_;
  std::optional<Eigen::Vector3d> estimate_;
  double last_command_mps2_ = 0.0;
};

}  // namespace roadbed::control
