#pragma once

// Private to tools/python: vehicles, drives and what moves beside them.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/tools/files/drive_file.h"
#include "roadbed/tools/files/vehicle_file.h"
#include "roadbed/tools/python/bindings.h"

namespace roadbed::tools::inline python {

/// A drive, and the file that holds it; empty if none does.
struct Trajectory {
  geometry::Trajectory drive;
  std::filesystem::path file = {};
  /// That a CommonRoad solution names, whose times count from time step 0; empty: it is of none.
  std::string vehicle_of_solution = {};
  std::vector<DriveGap> gaps = {};  ///< in which its log has no pose
};

/// A vehicle, and the file that holds it.
struct VehicleOfFile {
  Vehicle vehicle;
  std::filesystem::path file = {};
};

// What arguments may be: the object itself, the path of its file, and rows of numbers or nothing.

Trajectory trajectory_of(nb::handle given);
VehicleOfFile vehicle_of(nb::handle given);

/// Of what plans and drives. @throws std::invalid_argument if it is more than a rectangle.
geometry::VehicleShape shape_of(nb::handle given);

/// Obstacles, or the file that holds them.
struct Obstacles {
  std::vector<planning::ObstacleInSource> in_source;
  std::filesystem::path file = {};
};
/// @param start_step  of CommonRoad, as of `read_moving_obstacles`.
Obstacles obstacles_of(nb::handle given, std::optional<long> start_step = {});

}  // namespace roadbed::tools::python
