#include "roadbed/map/occupancy/clouds/point_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/clouds/cloud_formats.h"
#include "roadbed/map/occupancy/clouds/sensor_poses.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

constexpr double kNearZero = 4096.0;  // floats below it are exact to 0.25 mm

using Parser = RawCloud (*)(std::string_view, const std::string&);

bool begins_as_pcd(std::string_view bytes) {
  TextScanner lines(bytes.substr(0, 4096));
  while (!lines.done()) {
    std::string_view line = lines.next_line();
    if (line.starts_with("# .PCD")) return true;
    const std::string word = lower(next_word(line));
    if (word.empty() || word.starts_with('#')) continue;
    return word == "version" || word == "fields" || word == "columns";
  }
  return false;
}

Parser parser_by_suffix(const std::string& name) {
  const std::string suffix = lower(std::filesystem::path(name).extension().string());
  if (suffix == ".pcd") return parse_pcd;
  if (suffix == ".ply") return parse_ply;
  if (suffix == ".las" || suffix == ".laz") return parse_las;
  for (const char* text : {".xyz", ".csv", ".txt", ".asc", ".pts"}) {
    if (suffix == text) return parse_xyz;
  }
  return nullptr;
}

Parser choose_parser(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("LASF")) return parse_las;
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return parse_ply;
  if (begins_as_pcd(bytes)) return parse_pcd;
  if (const Parser parser = parser_by_suffix(name)) return parser;
  refuse_cloud(name, "", "", "is of no known point cloud format", ".pcd, .ply, .las, .xyz or .csv",
               "convert it, or rename it to what it is");
}

// The box around points, four at a time: their coordinates in a row are twelve places of a vector.
Box3 box_around(const std::vector<Eigen::Vector3f>& points) {
  constexpr std::size_t together = 12;
  std::array<float, together> least{}, most{};
  for (std::size_t k = 0; k < together; ++k) least[k] = most[k] = points[0].data()[k % 3];
  const float* at = points[0].data();
  const std::size_t whole = points.size() / 4;
  for (std::size_t i = 0; i < whole; ++i, at += together) {
    for (std::size_t k = 0; k < together; ++k) {
      least[k] = std::min(least[k], at[k]);
      most[k] = std::max(most[k], at[k]);
    }
  }
  Eigen::Vector3f low = points.back(), high = low;
  for (std::size_t i = 4 * whole; i < points.size(); ++i) {
    low = low.cwiseMin(points[i]);
    high = high.cwiseMax(points[i]);
  }
  for (std::size_t k = 0; k < together; ++k) {
    const auto axis = static_cast<Eigen::Index>(k % 3);
    low[axis] = std::min(low[axis], least[k]);
    high[axis] = std::max(high[axis], most[k]);
  }
  return {low.cast<double>(), high.cast<double>()};
}

Box3 box_around(const std::vector<Eigen::Vector3d>& points) {
  Box3 box{points.front(), points.front()};
  for (const Eigen::Vector3d& point : points) {
    box.min_in_source = box.min_in_source.cwiseMin(point);
    box.max_in_source = box.max_in_source.cwiseMax(point);
  }
  return box;
}

Eigen::Vector3d choose_origin(const Box3& box) {
  Eigen::Vector3d origin(0, 0, 0);
  for (int axis = 0; axis < 3; ++axis) {
    const double least = box.min_in_source[axis], most = box.max_in_source[axis];
    if (std::max(-least, most) > kNearZero) origin[axis] = std::round(0.5 * (least + most));
  }
  return origin;
}

// Where floats stay near zero they are kept as they are.
void take_floats(std::vector<Eigen::Vector3f> points, PointCloud& cloud) {
  cloud.origin_in_source = choose_origin(box_around(points));
  cloud.points = std::move(points);
  if (cloud.origin_in_source.isZero(0.0)) return;
  for (Eigen::Vector3f& point : cloud.points) {
    point = (point.cast<double>() - cloud.origin_in_source).cast<float>();
  }
}

void take_doubles(const std::vector<Eigen::Vector3d>& points, PointCloud& cloud) {
  cloud.origin_in_source = choose_origin(box_around(points));
  cloud.points.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    cloud.points.emplace_back((point - cloud.origin_in_source).cast<float>());
  }
}

/// A position left at zero in every point says nothing, like a viewpoint left at its default.
void take_sensors(RawCloud& raw, PointCloud& cloud) {
  cloud.sensor_in_source = raw.sensor_in_source;
  if (raw.scans.empty()) return;
  const std::optional<Eigen::Vector3d>& first = raw.scans.front().sensor_in_source;
  if (raw.scans.size() == 1 && first && first->isZero(0.0)) {
    raw.notes.emplace_back(
        "its points' sensor position is 0 0 0 in all of them and is not taken: give --sensor 0,0,0 "
        "if the sensor was there");
    return;
  }
  if (cloud.sensor_in_source) {
    raw.notes.emplace_back("its viewpoint is not taken, as its points have sensor positions");
  }
  cloud.sensor_in_source.reset();
  cloud.scans = std::move(raw.scans);
}

PointCloud relative_to_origin(RawCloud raw) {
  PointCloud cloud;
  if (!raw.float_points_in_source.empty()) {
    take_floats(std::move(raw.float_points_in_source), cloud);
  } else {
    take_doubles(raw.points_in_source, cloud);
  }
  cloud.format = std::move(raw.format);
  cloud.crs = std::move(raw.crs);
  cloud.unit = raw.unit;
  cloud.dropped_not_finite = raw.dropped_not_finite;
  take_sensors(raw, cloud);
  cloud.notes = std::move(raw.notes);
  if (raw.without_sensor > 0) {
    cloud.notes.push_back(fmt::format("{} points have no finite sensor position: no rays to them",
                                      raw.without_sensor));
  }
  return cloud;
}

}  // namespace

std::string_view name(LengthUnit unit) {
  constexpr std::array<std::string_view, 5> names{"unknown", "metres", "feet", "US survey feet",
                                                  "degrees"};
  return names[static_cast<std::size_t>(unit)];
}

Box3 bounds(const PointCloud& cloud) {
  Box3 box{cloud.in_source(0), cloud.in_source(0)};
  for (std::size_t i = 1; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d point = cloud.in_source(i);
    box.min_in_source = box.min_in_source.cwiseMin(point);
    box.max_in_source = box.max_in_source.cwiseMax(point);
  }
  return box;
}

PointCloud placed(const PointCloud& cloud, const Eigen::Isometry3d& world_from_sensor) {
  RawCloud raw;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    raw.points_in_source.emplace_back(world_from_sensor * cloud.in_source(i));
  }
  PointCloud moved = cloud;
  const PointCloud points = relative_to_origin(std::move(raw));
  moved.points = points.points;
  moved.origin_in_source = points.origin_in_source;
  moved.sensor_in_source = world_from_sensor.translation();
  for (ScanStart& scan : moved.scans) {
    if (scan.sensor_in_source) *scan.sensor_in_source = world_from_sensor * *scan.sensor_in_source;
  }
  return moved;
}

PointCloud scaled_to_metres(const PointCloud& cloud, double factor) {
  RawCloud raw;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    raw.points_in_source.emplace_back(cloud.in_source(i) * factor);
  }
  PointCloud scaled = relative_to_origin(std::move(raw));
  scaled.name = cloud.name;
  scaled.format = cloud.format;
  scaled.unit = LengthUnit::metre;
  scaled.dropped_not_finite = cloud.dropped_not_finite;
  if (cloud.sensor_in_source) scaled.sensor_in_source = *cloud.sensor_in_source * factor;
  scaled.scans = cloud.scans;
  for (ScanStart& scan : scaled.scans) {
    if (scan.sensor_in_source) *scan.sensor_in_source *= factor;
  }
  scaled.notes = cloud.notes;
  return scaled;
}

void check_is_in_metres(const PointCloud& cloud) {
  if (cloud.unit == LengthUnit::unknown || cloud.unit == LengthUnit::metre) return;
  refuse_cloud(cloud.name, "", cloud.crs, fmt::format("coordinates are in {}", name(cloud.unit)),
               "metres",
               cloud.unit == LengthUnit::degree ? "project the cloud first"
                                                : "project the cloud, or scale it by 0.3048");
}

PointCloud parse_point_cloud(std::string_view bytes, const std::string& name) {
  RawCloud raw = choose_parser(bytes, name)(bytes, name);
  if (raw.empty()) {
    refuse_cloud(name, "", "",
                 raw.dropped_not_finite == 0
                     ? "holds no point"
                     : fmt::format("none of its {} points is finite", raw.dropped_not_finite),
                 "at least one finite point", "check how the cloud was made");
  }
  PointCloud cloud = relative_to_origin(std::move(raw));
  cloud.name = name;
  return cloud;
}

PointCloud read_point_cloud(const std::filesystem::path& file) {
  return parse_point_cloud(read_file(file), file.string());
}

}  // namespace roadbed::map::occupancy::clouds
