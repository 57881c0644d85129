#pragma once

#include <optional>
#include <string>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::tools::inline files {

/// Which pose of the vehicle a file holds, and along which axes.
struct PoseFrame {
  geometry::Pose2 pose_in_vehicle = {};  ///< in the vehicle's frame (rear axle's centre)
  /// Of the poses and of what they are in: x to the right, y down, z ahead. Else z points up.
  bool is_camera = false;
};

/// What has to be said of drives whose files do not say it.
struct DriveOptions {
  std::string topic = {};                    ///< of a log; empty: the only one that is a drive
  std::optional<PoseFrame> pose_frame = {};  ///< of the poses in the file
  std::optional<double> rate_hz = {};        ///< of poses without time
};

/// How those words are written, for messages.
inline constexpr const char* kPoseFrameSyntax =
    "rear-axle, centre, X,Y[,HEADING] or camera[:X,Y[,HEADING]]";

/// The words of `--pose-frame`: rear-axle, centre, or X,Y[,HEADING] in metres ahead and to the left
/// of the rear axle's centre and radians; or camera, over the rear axle's centre, and camera:X,Y…,
/// elsewhere. None if they are something else.
std::optional<PoseFrame> pose_frame(const std::string& words, const geometry::VehicleShape& shape);

}  // namespace roadbed::tools::files
