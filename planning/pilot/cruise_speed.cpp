#include "roadbed/planning/pilot/cruise_speed.h"

#include "roadbed/geometry/motion/longitudinal.h"

namespace roadbed::planning::inline pilot {
namespace {

constexpr std::size_t kLeadCycles = 4;  // over which the lead's acceleration is taken

}  // namespace

CruiseSpeed::CruiseSpeed(const DrivingOptions& driving)
    : cruise_({.headway_s = driving.headway_s,
               .standstill_gap_m = driving.standstill_gap_m,
               .max_command_mps2 = kMostCommand_mps2}) {}

control::LeadMeasurement CruiseSpeed::measure(const Lead& lead, const VehicleState& measured) {
  return {.gap_m = lead.gap_m, .relative_speed_mps = lead.speed_mps - measured.speed_mps};
}

std::optional<Lead> CruiseSpeed::observe(const VehicleState& measured,
                                         const std::optional<Lead>& ahead, double t_s) {
  const double speed = measured.speed_mps;
  if (ahead && !sees(t_s)) {
    cruise_.observe_blind(speed);
  } else {
    std::optional<control::LeadMeasurement> seen;
    if (ahead) seen = measure(*ahead, measured);
    cruise_.observe(speed, measured.acceleration_mps2, seen);
  }
  const std::optional<control::LeadMeasurement> known = cruise_.lead();
  if (cruise_.restarted() || !known) lead_speeds_mps_.clear();
  if (!known || !ahead) return std::nullopt;
  const double lead_mps = speed + known->relative_speed_mps;
  lead_speeds_mps_.push_back(lead_mps);
  if (lead_speeds_mps_.size() > kLeadCycles + 1) lead_speeds_mps_.pop_front();
  return Lead{.obstacle = ahead->obstacle,
              .gap_m = known->gap_m,
              .speed_mps = lead_mps,
              .acceleration_mps2 = (lead_mps - lead_speeds_mps_.front()) /
                                   (kLeadCycles * geometry::kLongitudinal.cycle_s)};
}

double CruiseSpeed::acceleration_mps2(const VehicleState& measured, const SpeedTarget& set) {
  return cruise_.command(measured.speed_mps, measured.acceleration_mps2,
                         {set.speed_mps, set.acceleration_mps2});
}

}  // namespace roadbed::planning::pilot
