#pragma once

#include <memory>
#include <optional>
#include <string>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/behaviour/behaviour.h"
#include "roadbed/planning/behaviour/driving_task.h"
#include "roadbed/planning/behaviour/lateral_replanner.h"
#include "roadbed/planning/behaviour/planned_path.h"
#include "roadbed/planning/behaviour/speed_controller.h"

namespace roadbed::planning::inline behaviour {

/// What a pilot gets to see at one planning cycle.
struct PilotView {
  double t_s = 0.0;
  const VehicleState& measured;
  SpeedController& speed_controller;
};

/// What it wants until the next cycle.
struct PilotCommand {
  double acceleration_mps2 = 0.0;  ///< desired, to the actuator
  double set_speed_mps = 0.0;
  Behaviour behaviour = Behaviour::cruise;
  std::string reason;
  std::optional<DriveLead> lead;
  bool saturated = false;  ///< the cruise control asked for all it may
};

/// Plans path and speed, once every 0.1 s.
class Pilot {
 public:
  virtual ~Pilot() = default;
  virtual PilotCommand decide(const PilotView& view) = 0;

  /// The path to follow; of the last decision.
  virtual const LateralReplanner& replanner() const = 0;
};

struct PilotOptions {
  /// Beyond either, planning starts from the measured state instead of the last plan.
  double max_tracking_error_m = 0.3;
  double max_heading_error_rad = 0.15;
  /// Other vehicles are known only as could be at the time, not by their true future.
  bool predicts = false;
  /// Each cycle keeps what became of its candidates; all of them are judged, which takes longer.
  bool keeps_candidates = false;
};

/// What a pilot drives, kept by reference, and how.
struct PilotSetup {
  const DrivingTask& task;
  const geometry::VehicleShape& vehicle;
  DrivingOptions driving;
  PilotOptions pilot;
};

/// Follows what is ahead by the speed controller, up to a stop at the end of the route.
std::unique_ptr<Pilot> make_cruise_pilot(const PilotSetup& setup);

/// Knows what moves when, and has a goal in time: searches the s–t graph of its path.
/// @pre the task has a goal.
std::unique_ptr<Pilot> make_timed_pilot(const PilotSetup& setup);

}  // namespace roadbed::planning::behaviour
