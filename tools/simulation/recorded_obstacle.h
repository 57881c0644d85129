#pragma once

#include <filesystem>
#include <string>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/tools/files/drive_options.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline simulation {

/// Moves as a drive that was recorded, and is there from its first row to its last; one of a single
/// row stands.
struct RecordedObstacle {
  std::filesystem::path file;  ///< any that `read_drive` reads; resolved
  std::string pointer;         ///< JSON pointer of the whole, for messages
  DriveOptions options = {};
  geometry::Pose2 centre_in_vehicle = {};  ///< whose origin is the rear axle
  double offset_s = 0.0;                   ///< added to the times of the file
};

/// Reads `recorded` of a scenario's obstacle, but not the drive.
/// @param folder    that the file is named from.
/// @param length_m  of the obstacle.
/// @throws InputError with the JSON pointer of the fault.
RecordedObstacle recorded_obstacle_in(const JsonNode& node, const std::filesystem::path& folder,
                                      double length_m);

/// How the obstacle's centre moves, in source coordinates, in the scenario's time.
/// @throws InputError if the drive is unusable.
geometry::Trajectory motion_of(const RecordedObstacle& recorded);

}  // namespace roadbed::tools::simulation
