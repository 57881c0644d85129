#include "roadbed/map/occupancy/clouds/sweep_sensors.h"

#include <string>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/logs/feather.h"
#include "roadbed/map/logs/transform_tree.h"

namespace roadbed::map::inline occupancy::inline clouds {

std::optional<SweepSensors> SweepSensors::of_log(const std::filesystem::path& log) {
  const std::filesystem::path file = log / "calibration" / "egovehicle_SE3_sensor.feather";
  std::error_code unreadable;
  if (!std::filesystem::exists(file, unreadable)) return std::nullopt;
  const std::vector<FeatherColumn> columns =
      parse_feather(read_file(file), file.string(), {"tx_m", "ty_m", "tz_m"}, {"sensor_name"});
  SweepSensors sensors;
  bool has_up = false, has_down = false;
  const std::vector<std::string>& names = columns[3].texts;
  for (std::size_t row = 0; row < names.size(); ++row) {
    const auto value = [&](std::size_t column) {
      const FeatherColumn& of = columns[column];
      return of.is_whole ? static_cast<double>(of.wholes[row]) : of.reals[row];
    };
    const Eigen::Vector3d place(value(0), value(1), value(2));
    if (!place.allFinite()) continue;
    if (names[row] == "up_lidar") {
      sensors.up_in_vehicle_ = place;
      has_up = true;
    } else if (names[row] == "down_lidar") {
      sensors.down_in_vehicle_ = place;
      has_down = true;
    }
  }
  return has_up && has_down ? std::optional(std::move(sensors)) : std::nullopt;
}

Eigen::Vector3d SweepSensors::sensor_in_vehicle(const std::vector<TimedPose>& poses,
                                                std::int64_t sweep_ns, std::int64_t laser,
                                                std::int64_t offset_ns) {
  constexpr std::int64_t slot_ns = 1'000'000, first_of_down = 32;
  const std::int64_t slot = offset_ns / slot_ns;
  const auto [known, is_new] = moved_.try_emplace(slot, Eigen::Isometry3d::Identity());
  if (is_new) {
    const auto then = pose_at(poses, sweep_ns + slot * slot_ns),
               at_sweep = pose_at(poses, sweep_ns);
    if (then && at_sweep) known->second = at_sweep->inverse() * *then;
  }
  return known->second * (laser < first_of_down ? up_in_vehicle_ : down_in_vehicle_);
}

}  // namespace roadbed::map::occupancy::clouds
