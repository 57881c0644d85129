#include "roadbed/map/logs/argoverse_poses.h"
#include "roadbed/tools/files/drive_formats.h"

namespace roadbed::tools::inline files {

DrivePoses parse_argoverse_poses(std::string_view bytes, const std::string& name,
                                 const DriveOptions& options) {
  DrivePoses read{.unit = "row", .pose_in_vehicle = geometry::Pose2{}, .has_rotations = true};
  const std::vector<map::TimedPose> poses = map::read_ego_poses(bytes, name);
  for (const map::TimedPose& at : poses) {
    const std::int64_t since_ns = at.stamp_ns - poses.front().stamp_ns;
    read.poses.push_back(flat_pose(1e-9 * static_cast<double>(since_ns), at.pose, options));
    read.places.push_back(read.poses.size());
  }
  return read;
}

}  // namespace roadbed::tools::files
