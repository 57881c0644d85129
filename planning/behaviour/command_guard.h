#pragma once

#include "roadbed/planning/behaviour/hypothesis_speed.h"
#include "roadbed/planning/behaviour/maneuver_hypothesis.h"
#include "roadbed/planning/behaviour/planner_types.h"
#include "roadbed/planning/task/driving_task.h"

namespace roadbed::planning::inline behaviour {

/// Makes less of a command until the vehicle can stop after it on the path of the best hypothesis,
/// whatever those do who are measured, within `DrivingTask::others_within`; says so in the reason.
/// By ¼ g at most: braking harder is for what is foreseen, not for what may be. Where no command
/// leaves such a stop, as when somebody cuts in, that is news.
///
/// Looked at is whose centre is ahead of the vehicle's front; who crosses only if he is foreseen to
/// come into the way before the vehicle stands. Who is beside or behind keeps his distance himself.
/// Overtaking has been judged by bounds of its own (overtaking.h). Drives to a goal in time are
/// left as they are: recorded traffic does not react, and braking in it has a price of its own.
class CommandGuard {
 public:
  /// @param task  outlives it.
  explicit CommandGuard(const DrivingTask& task) : task_(task) {}

  /// Nothing where others' future is known. O(those near × stopping time).
  void look(const ManeuverHypothesis& best, const PlanningScene& scene, PlannerCommand& command);

 private:
  const DrivingTask& task_;
  bool could_stop_ = true;  ///< in the last cycle
};

}  // namespace roadbed::planning::behaviour
