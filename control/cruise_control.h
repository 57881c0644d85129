#pragma once

#include <Eigen/Core>
#include <optional>

#include "roadbed/control/cruise_design.h"

namespace roadbed::control {

/// What is known of the lead vehicle, measured with noise.
struct LeadMeasurement {
  double gap_m = 0.0;               ///< bumper to bumper
  double relative_speed_mps = 0.0;  ///< lead minus own
};

/// The speed to hold where no lead is nearer, and how it changes by itself.
struct SetSpeed {
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;  ///< of the set speed along the drive; fed forward
};

/// LQG cruise control (paper Fig. 10): follows a lead at τ_h v + d_0, or holds a set speed,
/// whichever asks for less. Call it once every `step_s`.
class CruiseControl {
 public:
  /// @throws std::invalid_argument as design_cruise does.
  explicit CruiseControl(const CruiseOptions& options);

  /// Takes what was seen of the lead.
  /// @param lead  none: no vehicle ahead is seen, and the filter forgets the last one. A
  ///              measurement that cannot be of the vehicle followed so far (its innovation is
  ///              beyond the χ² bound for one in a million) starts the filter anew.
  void observe(double speed_mps, double acceleration_mps2,
               const std::optional<LeadMeasurement>& lead);

  /// The same where the lead's measurement dropped out: the filter predicts on, for bridged_s at
  /// most; then, or if no lead was followed, as without a lead.
  void observe_blind(double speed_mps);

  /// Desired acceleration [m/s²] within ±max_command, and no further from the acceleration than
  /// the actuator's lag turns into max_jerk. The filter predicts with it.
  double command(double speed_mps, double acceleration_mps2, const SetSpeed& set);

  /// Another layer asked for something else than command(): the filter predicts with that.
  void sent(double command_mps2) { last_command_mps2_ = command_mps2; }

  /// observe() and command() in one.
  double update(double speed_mps, double acceleration_mps2, const SetSpeed& set,
                const std::optional<LeadMeasurement>& lead);

  const CruiseDesign& design() const { return design_; }

  /// x̂ after the last observation; none while no lead is followed.
  const std::optional<Eigen::Vector3d>& estimate() const { return estimate_; }

  /// Gap and relative speed by the estimate.
  std::optional<LeadMeasurement> lead() const;

  /// Whether the last observation began to follow a new lead.
  bool restarted() const { return restarted_; }

 private:
  void filter(const Eigen::Vector3d& measured);
  Eigen::Vector3d predicted() const;
  double desired_gap_m() const;

  CruiseOptions options_;
  CruiseDesign design_;
  Eigen::Matrix3d innovation_weight_;  ///< S⁻¹
  std::optional<Eigen::Vector3d> estimate_;
  bool restarted_ = false;
  double blind_s_ = 0.0;    ///< since the lead was last measured
  double speed_mps_ = 0.0;  ///< own, when last observed
  double last_command_mps2_ = 0.0;
};

}  // namespace roadbed::control
