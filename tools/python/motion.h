#pragma once

// Private to tools/python: vehicles, drives and what moves beside them.

#include <filesystem>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/tools/files/vehicle_file.h"
#include "roadbed/tools/python/bindings.h"

namespace roadbed::tools::inline python {

/// A drive, and the file that holds it; empty if none does.
struct Trajectory {
  geometry::Trajectory drive;
  std::filesystem::path file = {};
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
Obstacles obstacles_of(nb::handle given);

}  // namespace roadbed::tools::python
