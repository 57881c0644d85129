#pragma once

// Private to map/occupancy.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/clouds/cloud_formats.h"
#include "roadbed/map/occupancy/clouds/point_cloud.h"
#include "roadbed/map/occupancy/clouds/sweep_sensors.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// A sweep of Argoverse 2, Feather with columns x, y and z: points in the vehicle's frame at the
/// time that its name says, whatever times they were measured at.
RawCloud parse_sweep(std::string_view bytes, const std::string& name, const CloudFilter& filter);

/// A sweep LOG/sensors/lidar/TIME.feather in its log.
class SweepInLog {
 public:
  /// Reads LOG/city_SE3_egovehicle.feather and the log's calibration, where they are.
  /// @throws InputError if one is damaged.
  explicit SweepInLog(const std::filesystem::path& file);

  /// As `parse_sweep`, with where each point was measured from, if the log says where the lidars
  /// are: at the point's time (offset_ns) that of its laser (laser_number).
  RawCloud parse(std::string_view bytes, const std::string& name, const CloudFilter& filter);

  /// In the city's frame, by the pose at the sweep's time, with that time; as it is where the log
  /// has no poses.
  /// @throws InputError if the time lies before or after the poses.
  PointCloud in_city(PointCloud sweep) const;

 private:
  std::filesystem::path poses_file_;
  std::vector<TimedPose> poses_;  // empty: the sweep stays as it is
  std::int64_t stamp_ns_ = 0;
  std::optional<SweepSensors> sensors_;
};

}  // namespace roadbed::map::occupancy::clouds
