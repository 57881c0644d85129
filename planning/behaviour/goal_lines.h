#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/planning/behaviour/lateral_replanner.h"
#include "roadbed/planning/behaviour/planner_types.h"
#include "roadbed/planning/maneuvers/merging.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/reference/speed_ceiling.h"
#include "roadbed/planning/speed/timed_goal.h"
#include "roadbed/planning/task/stop_points.h"

namespace roadbed::planning::inline behaviour {

/// One line to the goal, and the path that is kept along it.
struct GoalLine {
  const ReferenceLine& line;
  double road_end_s_m;  ///< see road_end.h
  SpeedCeiling ceiling;
  std::vector<GoalStretch> stretches;
  std::vector<StopPoint> lights;
  LateralReplanner replanner;
};

/// The lines of a task, and which of them is driven.
class GoalLines {
 public:
  explicit GoalLines(const PlannerSetup& setup);
  GoalLines(const GoalLines&) = delete;
  GoalLines& operator=(const GoalLines&) = delete;

  /// The task's own line first.
  std::span<GoalLine> all() { return lines_; }
  GoalLine& first() { return lines_.front(); }
  GoalLine& driven() { return *driven_; }
  const GoalLine& driven() const { return *driven_; }

  /// From here on, one of those that the vehicle has been located on.
  void drive(GoalLine& on) { driven_ = &on; }

  /// From here on, as merging asks: its lines, or the first one.
  void drive_along(const Merging& merging, Merging::Along along, const VehicleState& measured);

 private:
  void change_to(GoalLine& on, const VehicleState& measured);

  struct LinesToMerge {
    std::shared_ptr<const MergeLines> lines;
    GoalLine own_lane, next_lane;
  };

  PlannerSetup setup_;
  std::vector<GoalLine> lines_;
  std::optional<LinesToMerge> to_merge_;
  GoalLine* driven_ = &lines_.front();
};

/// Whether two lines, and the room beside them, are the same from the vehicle on.
bool run_alike(const GoalLine& a, const GoalLine& b, double ahead_m);

}  // namespace roadbed::planning::behaviour
