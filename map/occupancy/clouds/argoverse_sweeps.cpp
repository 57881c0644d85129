#include "roadbed/map/occupancy/clouds/argoverse_sweeps.h"

#include <fmt/format.h>

#include <cstdint>
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

double value_at(const FeatherColumn& column, std::size_t row) {
  return column.is_whole ? static_cast<double>(column.wholes[row]) : column.reals[row];
}

}  // namespace

RawCloud parse_sweep(std::string_view bytes, const std::string& name, const CloudFilter& filter) {
  std::vector<std::string> names{"x", "y", "z"};
  if (filter.looks_at_attributes()) names.emplace_back("intensity");
  const AttributeFilter attributes(filter, names, name);
  const std::vector<FeatherColumn> columns = parse_feather(bytes, name, names);
  RawCloud cloud;
  cloud.format = "Feather (Argoverse 2)";
  cloud.unit = LengthUnit::metre;
  const std::size_t rows = columns[0].is_whole ? columns[0].wholes.size() : columns[0].reals.size();
  cloud.points_in_source.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto value = [&](std::size_t column) { return value_at(columns[column], row); };
    if (attributes.keeps(value)) {
      cloud.add({value(0), value(1), value(2)});
    } else {
      ++cloud.filtered_out;
    }
  }
  return cloud;
}

PointCloud in_city(PointCloud sweep, const std::filesystem::path& file) {
  const std::filesystem::path poses_file =
      std::filesystem::absolute(file).parent_path().parent_path().parent_path() / kPoses;
  const std::optional<std::uint64_t> stamp_ns = parse_count(file.stem().string());
  std::error_code unreadable;
  if (!stamp_ns || !std::filesystem::exists(poses_file, unreadable)) {
    sweep.notes.push_back(
        fmt::format("its points are in the vehicle's frame: there is no {} two folders up, or the "
                    "file is not named by its time",
                    kPoses));
    return sweep;
  }
  std::vector<TimedPose> poses = read_ego_poses(read_file(poses_file), poses_file.string());
  sort_by_stamp(poses);
  const auto pose = pose_at(poses, static_cast<std::int64_t>(*stamp_ns));
  if (!pose) {
    refuse_cloud(sweep.name, "", "time", fmt::format("{} ns", *stamp_ns),
                 fmt::format("one between the first and the last of {}", poses_file.string()),
                 "get the poses of the same log");
  }
  sweep.stamp_ns = static_cast<std::int64_t>(*stamp_ns);
  sweep.drive_start_ns = poses.front().stamp_ns;
  if (sweep.points.empty()) return sweep;
  PointCloud moved = placed(sweep, *pose);
  moved.sensor_in_source.reset();  // it is somewhere on the vehicle
  return moved;
}

}  // namespace roadbed::map::occupancy::clouds
