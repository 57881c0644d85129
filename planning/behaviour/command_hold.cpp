#include "roadbed/planning/behaviour/command_hold.h"

#include <algorithm>

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kHeld_s = 0.6, kGrows_mps3 = 3.0;

bool gives_way(const PlannerCommand& command) {
  return command.behaviour == Behaviour::yield || command.behaviour == Behaviour::emergency;
}

}  // namespace

void CommandHold::look(double t_s, double law_mps2, PlannerCommand& command) {
  const bool is_held = last_ && t_s < last_->t_s + kHeld_s;
  if (gives_way(command) && command.acceleration_mps2 < law_mps2) {
    if (is_held && last_->behaviour == Behaviour::emergency) command.behaviour = last_->behaviour;
    last_ = {.t_s = t_s, .behaviour = command.behaviour, .reason = command.reason};
  } else if (is_held) {
    hold(t_s, command);
  }
  commanded_mps2_ = command.acceleration_mps2;
  commanded_at_s_ = t_s;
}

void CommandHold::hold(double t_s, PlannerCommand& command) const {
  if (command.behaviour != Behaviour::cruise && command.behaviour != Behaviour::pass) return;
  const double most_mps2 = commanded_mps2_ + kGrows_mps3 * (t_s - commanded_at_s_);
  command.acceleration_mps2 = std::min(command.acceleration_mps2, most_mps2);
  command.behaviour = last_->behaviour;
  command.reason = last_->reason;
}

}  // namespace roadbed::planning::behaviour
