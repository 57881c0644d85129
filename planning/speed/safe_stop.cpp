#include "roadbed/planning/speed/safe_stop.h"

#include <algorithm>

#include "roadbed/geometry/motion/longitudinal.h"
#include "roadbed/planning/speed/speed_question.h"

namespace roadbed::planning::inline speed {
namespace {

constexpr double kLook_s = geometry::kLongitudinal.cycle_s;  // a command is held for so long
constexpr double kBraking_mps2 = geometry::kLongitudinal.max_braking_mps2;
constexpr double kAtRest_mps = 0.05;

/// A command is held until the next one, then the vehicle brakes.
class Stopping {
 public:
  Stopping(const StopQuestion& question, double command_mps2)
      : command_mps2_(command_mps2),
        state_{.speed_mps = question.speed_mps, .acceleration_mps2 = question.acceleration_mps2} {}

  bool stands() const { return state_.t_s > 0.0 && state_.speed_mps <= kAtRest_mps; }
  const SpeedState& state() const { return state_; }

  void go_on() {
    state_ = followed(state_, state_.t_s > 0.0 ? -kBraking_mps2 : command_mps2_, kLook_s);
  }

 private:
  double command_mps2_;
  SpeedState state_;
};

}  // namespace

double stop_s(const StopQuestion& question, double command_mps2) {
  Stopping drive(question, command_mps2);
  while (!drive.stands()) drive.go_on();
  return drive.state().t_s;
}

std::optional<std::size_t> who_may_bar_stop(const StopQuestion& question, double command_mps2) {
  const PathProfile& path = question.profile;
  Stopping drive(question, command_mps2);
  while (!drive.stands()) {
    const double from_s = drive.state().t_s;
    const std::size_t first = path.before(drive.state().ahead_m);
    drive.go_on();
    const double to_s = drive.state().t_s;
    const std::size_t last = std::min(path.before(drive.state().ahead_m) + 1, path.body.size() - 1);
    for (std::size_t i = 0; i < question.others.size(); ++i) {
      for (std::size_t k = first; k <= last; ++k) {
        if (question.others[i].set.may_touch(path.body[k], from_s, to_s)) return i;
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
  const bool may_brake = !who_may_bar_stop(question, -kBraking_mps2);
  return {std::min(wanted_mps2, may_brake ? -kGentle_mps2 : 0.0), who, false};
}

}  // namespace roadbed::planning::speed
