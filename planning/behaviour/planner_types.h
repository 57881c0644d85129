#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/behaviour/behaviour.h"
#include "roadbed/planning/behaviour/detour.h"
#include "roadbed/planning/behaviour/hypothesis_outcome.h"
#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/planning/speed/speed_controller.h"
#include "roadbed/planning/speed/speed_question.h"
#include "roadbed/planning/task/driving_task.h"

namespace roadbed::planning::inline behaviour {

/// What the planner gets to see at one cycle.
struct PlannerView {
  double t_s = 0.0;
  const VehicleState& measured;
  SpeedController& speed_controller;
  bool explains = false;  ///< keep what became of every candidate (LateralReplanner::explained())
};

inline constexpr double kUsualLateral_mps2 = 3.9;  ///< that the wheels are turned for

/// What it wants until the next cycle.
struct PlannerCommand {
  double acceleration_mps2 = 0.0;  ///< desired, to the actuator
  double set_speed_mps = 0.0;
  double most_lateral_mps2 = kUsualLateral_mps2;  ///< that the wheels may be turned for
  Behaviour behaviour = Behaviour::cruise;
  std::string reason;
  std::optional<DriveLead> lead;
  std::optional<double> halt_m = {};  ///< along the line, to where a rule of the road asks to wait
  bool saturated = false;             ///< the cruise control asked for all it may
  std::vector<HypothesisOutcome> hypotheses = {};  ///< by the order in which they were looked at
  /// What is foreseen to be driven along the path, from its state now; not empty.
  std::vector<SpeedState> drive = {};
  bool is_news = false;  ///< the reason is worth an event
  /// To be put into the task before the next decision, by a planner of its own.
  std::optional<Detour> detour = {};
};

/// How it plans, whatever it drives.
struct PlannerOptions {
  /// Beyond either, planning starts from the measured state instead of the last plan.
  double max_tracking_error_m = 0.3;
  double max_heading_error_rad = 0.15;
  /// Each cycle keeps what became of its candidates, which takes longer.
  bool keeps_candidates = false;
};

/// What is driven, kept by reference, and how.
struct PlannerSetup {
  const DrivingTask& task;
  const geometry::VehicleShape& vehicle;
  DrivingOptions driving;
  PlannerOptions planner;
};

}  // namespace roadbed::planning::behaviour
