#include "roadbed/tools/cli/drive_arguments.h"

namespace roadbed::tools::inline cli {

std::vector<Argument> DriveArguments::declare(Arguments& arguments) {
  std::vector<Argument> declared;
  declared.push_back(arguments.add(
      "--topic", topic_,
      "Of a log: the topic that is the drive, where several could be (drive info lists them); "
      "NAME#K is the K-th planned trajectory of the topic"));
  declared.push_back(
      arguments
          .add("--pose-frame", frame_,
               "Which point of the vehicle the poses of a log or of pose lines are: rear-axle, "
               "centre (of the body), or X,Y[,HEADING] ahead and to the left of the rear axle "
               "[m, rad]; camera[:X,Y[,HEADING]] where they are a camera's as in KITTI's odometry "
               "(x right, y down, z ahead), over the rear axle or at X,Y. Default: rear-axle; of "
               "TUM and KITTI none")
          .checked([](const std::string& words) -> std::string {
            return pose_frame(words, {}) ? "" : std::string("is none of ") + kPoseFrameSyntax;
          }));
  declared.push_back(
      arguments.add("--rate", rate_hz_, "Poses, or steps, in a second, where a file has no times")
          .within(1e-3, 1e6));
  return declared;
}

DriveOptions DriveArguments::options(const geometry::VehicleShape& shape) const {
  DriveOptions options{.topic = topic_, .pose_frame = {}, .rate_hz = rate_hz_};
  if (!frame_.empty()) options.pose_frame = pose_frame(frame_, shape);
  return options;
}

}  // namespace roadbed::tools::cli
