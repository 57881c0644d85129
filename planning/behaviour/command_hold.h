#pragma once

#include <optional>
#include <string>

#include "roadbed/planning/behaviour/behaviour.h"
#include "roadbed/planning/behaviour/planner_types.h"

namespace roadbed::planning::inline behaviour {

/// Gives way to somebody for 0.6 s longer than in each single cycle: who is just met, or just not,
/// as both go on, would have the vehicle brake and speed up in turns.
///
/// Until then the acceleration grows by 3 m/s³ at most, and behaviour and reason stay; braking is
/// never less than it was asked for.
class CommandHold {
 public:
  /// @param law_mps2  what would have been commanded with nobody to give way to.
  void look(double t_s, double law_mps2, PlannerCommand& command);

 private:
  void hold(double t_s, PlannerCommand& command) const;

  struct GivenWay {
    double t_s;
    Behaviour behaviour;
    std::string reason;
  };
  std::optional<GivenWay> last_;
  double commanded_mps2_ = 0.0, commanded_at_s_ = 0.0;
};

}  // namespace roadbed::planning::behaviour
