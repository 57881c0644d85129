#include "roadbed/planning/speed/safe_stop.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/motion/longitudinal.h"

namespace roadbed::planning::inline speed {
namespace {

constexpr double kLook_s = 0.1, kDrivenStep_s = 0.01;
constexpr double kAtRest_mps = 0.05;

/// Drives on for a while; the actuator follows its command with a lag.
class Stopping {
 public:
  Stopping(const StopQuestion& question, double command_mps2)
      : q_(question),
        command_mps2_(command_mps2),
        speed_mps_(question.speed_mps),
        acceleration_mps2_(question.acceleration_mps2) {}

  bool stands() const { return t_s_ >= q_.held_for_s && speed_mps_ <= kAtRest_mps; }
  double t_s() const { return t_s_; }
  double ahead_m() const { return ahead_m_; }

  void go_on(double for_s) {
    const auto steps = static_cast<int>(std::lround(for_s / kDrivenStep_s));
    for (int i = 0; i < steps; ++i) {
      const double wanted_mps2 = t_s_ < q_.held_for_s - 1e-9 ? command_mps2_ : -q_.braking_mps2;
      acceleration_mps2_ += (wanted_mps2 - acceleration_mps2_) * kDrivenStep_s /
                            geometry::kLongitudinal.actuator_lag_s;
      const double then_mps = std::max(0.0, speed_mps_ + acceleration_mps2_ * kDrivenStep_s);
      ahead_m_ += 0.5 * (speed_mps_ + then_mps) * kDrivenStep_s;
      speed_mps_ = then_mps;
      t_s_ += kDrivenStep_s;
    }
  }

 private:
  const StopQuestion& q_;
  double command_mps2_;
  double t_s_ = 0.0, ahead_m_ = 0.0, speed_mps_, acceleration_mps2_;
};

}  // namespace

double stop_s(const StopQuestion& question, double command_mps2) {
  Stopping drive(question, command_mps2);
  while (!drive.stands()) drive.go_on(kLook_s);
  return drive.t_s();
}

std::optional<std::size_t> who_may_bar_stop(const StopQuestion& question, double command_mps2) {
  const PathProfile& path = question.profile;
  Stopping drive(question, command_mps2);
  while (!drive.stands()) {
    const double from_s = drive.t_s();
    const std::size_t first = path.before(drive.ahead_m());
    drive.go_on(kLook_s);
    const std::size_t last = std::min(path.before(drive.ahead_m()) + 1, path.body.size() - 1);
    for (std::size_t i = 0; i < question.others.size(); ++i) {
      for (std::size_t k = first; k <= last; ++k) {
        if (question.others[i].set.may_touch(path.body[k], from_s, drive.t_s())) return i;
      }
    }
  }
  return std::nullopt;
}

SafeCommand safe_command(const StopQuestion& question, double wanted_mps2) {
  constexpr double kGentle_mps2 = geometry::kLongitudinal.max_command_mps2;
  const auto who = who_may_bar_stop(question, wanted_mps2);
  if (!who) return {.command_mps2 = wanted_mps2};
  for (const double command_mps2 : {0.0, -1.0, -kGentle_mps2}) {
    if (command_mps2 >= wanted_mps2) continue;
    if (!who_may_bar_stop(question, command_mps2)) return {command_mps2, who, true};
  }
  const bool may_brake = !who_may_bar_stop(question, -question.braking_mps2);
  return {std::min(wanted_mps2, may_brake ? -kGentle_mps2 : 0.0), who, false};
}

}  // namespace roadbed::planning::speed
