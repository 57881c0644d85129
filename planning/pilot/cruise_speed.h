#pragma once

#include <deque>
#include <optional>

#include "roadbed/control/cruise_control.h"
#include "roadbed/planning/speed/speed_controller.h"
#include "roadbed/planning/task/driving_task.h"

namespace roadbed::planning::inline pilot {

/// The LQG cruise control as the planner asks it: what is known of the lead is what its filter
/// makes of measurements.
class CruiseSpeed : public SpeedController {
 public:
  explicit CruiseSpeed(const DrivingOptions& driving);

  std::optional<Lead> observe(const VehicleState& measured, const std::optional<Lead>& ahead,
                              double t_s) override;
  double acceleration_mps2(const VehicleState& measured, const SpeedTarget& set) override;
  void sent(double acceleration_mps2) override { cruise_.sent(acceleration_mps2); }

 protected:
  /// Whether a lead can be measured at this time; asked once a cycle while there is one.
  virtual bool sees(double /*t_s*/) { return true; }

  /// What is measured of it; as it is, unless sensors say otherwise.
  virtual control::LeadMeasurement measure(const Lead& lead, const VehicleState& measured);

 private:
  control::CruiseControl cruise_;
  std::deque<double> lead_speeds_mps_;  ///< of the last cycles
};

}  // namespace roadbed::planning::pilot
