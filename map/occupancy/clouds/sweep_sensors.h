#pragma once

// Private to map/occupancy/clouds.

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <unordered_map>
#include <vector>

#include "roadbed/map/logs/timed_pose.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// Where the lidars of a log of Argoverse 2 were, by LOG/calibration/egovehicle_SE3_sensor.feather:
/// lasers 0 to 31 of a sweep are those of up_lidar, 32 to 63 those of down_lidar.
class SweepSensors {
 public:
  /// None where the log has no calibration, or that has not both lidars.
  /// @throws InputError if the file is damaged.
  static std::optional<SweepSensors> of_log(const std::filesystem::path& log);

  /// Where it was when it measured, in the vehicle's frame at the time of the sweep, to a
  /// millisecond of motion; as if the vehicle stood where the log has no pose at that time.
  /// @param poses  of the vehicle, by time.
  Eigen::Vector3d sensor_in_vehicle(const std::vector<TimedPose>& poses, std::int64_t sweep_ns,
                                    std::int64_t laser, std::int64_t offset_ns);

 private:
  Eigen::Vector3d up_in_vehicle_{0, 0, 0}, down_in_vehicle_{0, 0, 0};
  std::unordered_map<std::int64_t, Eigen::Isometry3d> moved_;  // by milliseconds after the sweep
};

}  // namespace roadbed::map::occupancy::clouds
