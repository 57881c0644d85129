#include "roadbed/map/occupancy/clouds/argoverse_sweeps.h"

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/logs/argoverse_poses.h"
#include "roadbed/map/logs/feather.h"
#include "roadbed/map/logs/transform_tree.h"
#include "roadbed/map/occupancy/clouds/attribute_filter.h"
#include "roadbed/map/occupancy/clouds/cloud_transforms.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

constexpr const char* kPoses = "city_SE3_egovehicle.feather";

/// Where a point was measured from, by its laser and how long after the sweep's time [ns].
using SensorOfRow = std::function<Eigen::Vector3d(double laser, double offset_ns)>;

double value_at(const FeatherColumn& column, std::size_t row) {
  return column.is_whole ? static_cast<double>(column.wholes[row]) : column.reals[row];
}

RawCloud parse_rows(std::string_view bytes, const std::string& name, const CloudFilter& filter,
                    const SensorOfRow& sensor_of) {
  std::vector<std::string> names{"x", "y", "z"};
  if (filter.looks_at_attributes()) names.emplace_back("intensity");
  const AttributeFilter attributes(filter, names, name);
  if (sensor_of) names.insert(names.end(), {"laser_number", "offset_ns"});
  const std::vector<FeatherColumn> columns = parse_feather(bytes, name, names);
  RawCloud cloud;
  cloud.format = "Feather (Argoverse 2)";
  cloud.unit = LengthUnit::metre;
  const std::size_t rows = columns[0].is_whole ? columns[0].wholes.size() : columns[0].reals.size();
  cloud.points_in_source.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto value = [&](std::size_t column) { return value_at(columns[column], row); };
    if (!attributes.keeps(value)) {
      ++cloud.filtered_out;
    } else if (sensor_of) {
      const std::size_t last = columns.size() - 1;
      cloud.add({value(0), value(1), value(2)}, sensor_of(value(last - 1), value(last)));
    } else {
      cloud.add({value(0), value(1), value(2)});
    }
  }
  return cloud;
}

}  // namespace

RawCloud parse_sweep(std::string_view bytes, const std::string& name, const CloudFilter& filter) {
  return parse_rows(bytes, name, filter, {});
}

SweepInLog::SweepInLog(const std::filesystem::path& file) {
  const std::filesystem::path log =
      std::filesystem::absolute(file).parent_path().parent_path().parent_path();
  poses_file_ = log / kPoses;
  const std::optional<std::uint64_t> stamp_ns = parse_count(file.stem().string());
  std::error_code unreadable;
  if (!stamp_ns || *stamp_ns >> 62 != 0 || !std::filesystem::exists(poses_file_, unreadable))
    return;
  stamp_ns_ = static_cast<std::int64_t>(*stamp_ns);
  poses_ = read_ego_poses(read_file(poses_file_), poses_file_.string());
  sort_by_stamp(poses_);
  sensors_ = SweepSensors::of_log(log);
}

RawCloud SweepInLog::parse(std::string_view bytes, const std::string& name,
                           const CloudFilter& filter) {
  if (!sensors_) return parse_sweep(bytes, name, filter);
  return parse_rows(bytes, name, filter, [&](double laser, double offset_ns) {
    return sensors_->sensor_in_vehicle(poses_, stamp_ns_, static_cast<std::int64_t>(laser),
                                       static_cast<std::int64_t>(offset_ns));
  });
}

PointCloud SweepInLog::in_city(PointCloud sweep) const {
  if (poses_.empty()) {
    sweep.notes.push_back(
        fmt::format("its points are in the vehicle's frame: there is no {} two folders up, or the "
                    "file is not named by its time",
                    kPoses));
    return sweep;
  }
  const auto pose = pose_at(poses_, stamp_ns_);
  if (!pose) {
    refuse_cloud(sweep.name, "", "time", fmt::format("{} ns", stamp_ns_),
                 fmt::format("one between the first and the last of {}", poses_file_.string()),
                 "get the poses of the same log");
  }
  sweep.stamp_ns = stamp_ns_;
  sweep.drive_start_ns = poses_.front().stamp_ns;
  if (sweep.points.empty()) return sweep;
  PointCloud moved = placed(sweep, *pose);
  moved.sensor_in_source.reset();  // without a calibration it is somewhere on the vehicle
  return moved;
}

}  // namespace roadbed::map::occupancy::clouds
