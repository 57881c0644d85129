#pragma once

#include <string>

#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline simulation {

/// Looks at the true state of a drive: distances to obstacles, and the rows of the
/// trajectory.
class GroundTruthMonitor {
 public:
  GroundTruthMonitor(const World& world, const geometry::VehicleShape& vehicle);

  /// Distance to the nearest obstacle at a time [m], infinite without any; remembers the least
  /// since the last row, and the obstacle that is touched, if one is.
  void look(double t_s, const planning::VehicleState& truth);

  /// Id of an obstacle that the body touches; empty if none.
  const std::string& touched() const { return touched_; }

  /// Least clearance since the last row; starts anew.
  double take_clearance_m();

  /// Row of the trajectory, in source coordinates.
  geometry::TrajectoryPoint row(double t_s, const planning::VehicleState& truth) const;

 private:
  const World& world_;
  const geometry::VehicleShape& vehicle_;
  double clearance_m_;
  std::string touched_;
};

}  // namespace roadbed::tools::simulation
