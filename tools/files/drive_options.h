#pragma once

#include <optional>
#include <string>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::tools::inline files {

/// What has to be said of drives whose files do not say it.
struct DriveOptions {
  std::string topic = {};  ///< of a log; empty: the only one that is a drive
  /// Which pose of the vehicle is in the file, in the vehicle's frame (rear axle's centre).
  std::optional<geometry::Pose2> pose_in_vehicle = {};
  std::optional<double> rate_hz = {};  ///< of poses without time
};

/// The words of `--pose-frame`: rear-axle, centre, or X,Y[,HEADING] in metres ahead and to the left
/// of the rear axle's centre and radians. None if they are something else.
std::optional<geometry::Pose2> pose_frame(const std::string& words,
                                          const geometry::VehicleShape& shape);

}  // namespace roadbed::tools::files
