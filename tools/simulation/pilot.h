#pragma once

#include <memory>
#include <optional>
#include <string>

#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/path_keeper.h"
#include "roadbed/tools/simulation/sensors.h"

namespace roadbed::tools {

struct LoopOptions;

/// What a pilot gets to see at one planning cycle.
struct PilotView {
  double t_s = 0.0;
  const VehicleState& measured;
  double true_speed_mps = 0.0;  ///< for the sensors only
  Sensors& sensors;
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
  virtual const PathKeeper& keeper() const = 0;
};

/// Follows what is ahead by the cruise control, up to a stop at the end of the route.
std::unique_ptr<Pilot> make_cruise_pilot(const Scenario& scenario, const World& world,
                                         const LoopOptions& options);

/// Knows what moves when, and has a goal in time: searches the s–t graph of its path.
/// @pre the world has a goal.
std::unique_ptr<Pilot> make_timed_pilot(const Scenario& scenario, const World& world,
                                        const LoopOptions& options);

}  // namespace roadbed::tools
