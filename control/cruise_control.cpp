#include "roadbed/control/cruise_control.h"

#include <Eigen/Dense>
#include <algorithm>

namespace roadbed::control {
namespace {

constexpr double kMostInnovation = 30.66;  // χ², three degrees of freedom, 10⁻⁶ beyond

}  // namespace

CruiseControl::CruiseControl(const CruiseOptions& options)
    : options_(options), design_(design_cruise(options)), innovation_weight_(design_.S.inverse()) {}

double CruiseControl::desired_gap_m() const {
  return options_.headway_s * speed_mps_ + options_.standstill_gap_m;
}

void CruiseControl::observe(double speed_mps, double acceleration_mps2,
                            const std::optional<LeadMeasurement>& lead) {
  restarted_ = false;
  blind_s_ = 0.0;
  speed_mps_ = speed_mps;
  if (lead) {
    filter({desired_gap_m() - lead->gap_m, lead->relative_speed_mps, acceleration_mps2});
  } else {
    estimate_.reset();
  }
}

void CruiseControl::observe_blind(double speed_mps) {
  restarted_ = false;
  blind_s_ += options_.step_s;
  speed_mps_ = speed_mps;
  if (estimate_ && blind_s_ <= options_.bridged_s) {
    estimate_ = predicted();
  } else {
    estimate_.reset();
  }
}

std::optional<LeadMeasurement> CruiseControl::lead() const {
  if (!estimate_) return std::nullopt;
  return LeadMeasurement{.gap_m = desired_gap_m() - (*estimate_)[0],
                         .relative_speed_mps = (*estimate_)[1]};
}

double CruiseControl::update(double speed_mps, double acceleration_mps2, const SetSpeed& set,
                             const std::optional<LeadMeasurement>& lead) {
  observe(speed_mps, acceleration_mps2, lead);
  return command(speed_mps, acceleration_mps2, set);
}

double CruiseControl::command(double speed_mps, double acceleration_mps2, const SetSpeed& set) {
  const Eigen::Vector2d speed_error{set.speed_mps - speed_mps,
                                    acceleration_mps2 - set.acceleration_mps2};
  double wanted = set.acceleration_mps2 - design_.K_speed.dot(speed_error);
  if (estimate_) wanted = std::min(wanted, -design_.K.dot(*estimate_));
  const double change = options_.max_jerk_mps3 * options_.actuator_lag_s;
  wanted = std::clamp(wanted, (acceleration_mps2 - change) / options_.actuator_gain,
                      (acceleration_mps2 + change) / options_.actuator_gain);
  last_command_mps2_ = std::clamp(wanted, -options_.max_command_mps2, options_.max_command_mps2);
  return last_command_mps2_;
}

Eigen::Vector3d CruiseControl::predicted() const {
  return design_.model.A * *estimate_ + design_.model.B * last_command_mps2_;
}

void CruiseControl::filter(const Eigen::Vector3d& measured) {
  if (estimate_) {
    const Eigen::Vector3d innovation = measured - predicted();
    if (innovation.dot(innovation_weight_ * innovation) <= kMostInnovation) {
      estimate_ = predicted() + design_.L * innovation;
      return;
    }
  }
  restarted_ = true;
  estimate_ = measured;
}

}  // namespace roadbed::control
