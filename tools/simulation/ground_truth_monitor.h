#pragma once

#include <optional>

#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/tools/simulation/collision.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline simulation {

/// Looks at the true state of a drive: distances to obstacles, and the rows of the
/// trajectory.
class GroundTruthMonitor {
 public:
  GroundTruthMonitor(const World& world, const geometry::VehicleShape& vehicle);

  /// Distance to the nearest obstacle at a time [m], infinite without any; remembers the least
  /// since the last row, and the first collision, if there is one.
  void look(double t_s, const planning::VehicleState& truth);

  /// Who is touched, first of all; none if nobody is.
  const std::optional<Collision>& collision() const { return collision_; }

  /// Least clearance since the last row; starts anew.
  double take_clearance_m();

  /// Row of the trajectory, in source coordinates.
  geometry::TrajectoryPoint row(double t_s, const planning::VehicleState& truth) const;

 private:
  const World& world_;
  const geometry::VehicleShape& vehicle_;
  double clearance_m_;
  std::optional<Collision> collision_;
};

}  // namespace roadbed::tools::simulation
