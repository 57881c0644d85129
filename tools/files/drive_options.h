#pragma once

#include <optional>
#include <string>

#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::tools::inline files {

/// What has to be said of drives whose files do not say it.
struct DriveOptions {
  std::string topic = {};  ///< of a log; empty: the only one that is a drive
  /// Which pose of the vehicle is in the file, in the vehicle's frame (rear axle's centre).
  std::optional<geometry::Pose2> pose_in_vehicle = {};
  std::optional<double> rate_hz = {};  ///< of poses without time
};

}  // namespace roadbed::tools::files
