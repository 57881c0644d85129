#pragma once

#include "roadbed/geometry/motion/longitudinal.h"

namespace roadbed::control {

/// Lower controller, actuator and vehicle together: a_f = K_L / (T_L s + 1) · a_des (paper eq. 25).
struct ActuatorOptions {
  double lag_s = geometry::kLongitudinal.actuator_lag_s;  ///< T_L
  double gain = geometry::kLongitudinal.actuator_gain;    ///< K_L
};

/// Acceleration after `step_s` of a constant desired acceleration, exact for any step.
/// @throws std::invalid_argument if the lag is not positive or the step is negative.
double actuate(double acceleration_mps2, double desired_mps2, double step_s,
               const ActuatorOptions& options = {});

/// What drives, brakes and holds a vehicle back along the road. Mass of CommonRoad's vehicle 2, the
/// rest as usual for a car of its size.
struct DriveTrain {
  double mass_kg = 1093.3;
  double drag_area_m2 = 0.65;  ///< c_d A
  double air_density_kgpm3 = 1.225;
  double rolling_resistance = 0.012;                      ///< of the weight
  double full_throttle_N = 5000.0;                        ///< at the wheels
  double full_brake_N = 11'000.0;                         ///< at the wheels
  double lag_s = geometry::kLongitudinal.actuator_lag_s;  ///< T_L, of the force behind the pedals
};

/// Both between 0 and 1; never both above 0.
struct Pedals {
  double throttle = 0.0;
  double brake = 0.0;
};

/// Drag, rolling resistance and the weight's share on a grade, as a force against the motion [N].
/// @param grade_rad  positive uphill.
double resistance_N(double speed_mps, double grade_rad, const DriveTrain& train);

/// Lower controller (paper section 3.3): a desired acceleration as pedals, by the vehicle's inverse
/// model, so that pedals and vehicle together behave as K_L / (T_L s + 1) (paper eq. 25) with
/// K_L = 1 at any speed and grade. Between throttle and brake lies a band of force in which neither
/// is used, left only on the side that was used last: small changes do not make the foot jump.
class PedalController {
 public:
  /// @param band_N  of force, in which neither pedal is used.
  explicit PedalController(const DriveTrain& train, double band_N = 50.0)
      : train_(train), band_N_(band_N) {}

  /// To be called at every step; a positive grade is uphill.
  Pedals update(double desired_mps2, double speed_mps, double grade_rad);

 private:
  DriveTrain train_;
  double band_N_;
  bool brakes_ = false;  ///< which pedal was used last
};

/// A vehicle behind its pedals, along the road.
struct DrivenState {
  double speed_mps = 0.0;
  double force_N = 0.0;  ///< at the wheels; negative brakes
};

/// Acceleration of a vehicle that rolls [m/s²].
double acceleration_mps2(const DrivenState& state, double grade_rad, const DriveTrain& train);

/// State after `step_s`; the force follows the pedals with the lag, exactly; the speed stays ≥ 0.
DrivenState drive(const DrivenState& state, const Pedals& pedals, double grade_rad, double step_s,
                  const DriveTrain& train);

}  // namespace roadbed::control
