#pragma once

// Private to tools/files: readers of the single formats of drives.

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/tools/files/drive_options.h"

namespace roadbed::tools::inline files {

/// A pose as a file has it.
struct DrivePose {
  double t_s;
  double x_m, y_m, heading_rad;
  std::optional<double> speed_mps = {};
  double z_m = 0.0;  ///< up
};

/// What a file holds.
struct DrivePoses {
  std::vector<DrivePose> poses = {};
  std::string unit;  ///< what a place in messages counts: "pose", "line"
  std::vector<std::size_t> places = {};
  std::optional<geometry::Pose2> pose_in_vehicle = {};  ///< what the format says of it
  bool has_rotations = false;  ///< which cannot be degrees, however they fit the way
};

/// Of an upright body; heading is that of its x axis in the plane, or a camera's z axis.
DrivePose flat_pose(double t_s, const Eigen::Isometry3d& pose, const DriveOptions& options);

/// Whether it is a camera's poses that the options say a file holds.
bool is_of_camera(const DriveOptions& options);

// One file each.
bool begins_as_pose_lines(std::string_view bytes);
DrivePoses parse_pose_lines(std::string_view bytes, const std::string& name,
                            const DriveOptions& options);
bool begins_as_solution(std::string_view bytes);
DrivePoses parse_solution(std::string_view bytes, const std::string& name,
                          const DriveOptions& options);
DrivePoses parse_argoverse_poses(std::string_view bytes, const std::string& name,
                                 const DriveOptions& options);

/// The time between poses. @throws InputError if it was not said.
double needed_step_s(const DriveOptions& options, const std::string& name,
                     const std::string& format);

}  // namespace roadbed::tools::files
