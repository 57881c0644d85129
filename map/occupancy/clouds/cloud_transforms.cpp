#include "roadbed/map/occupancy/clouds/cloud_transforms.h"

#include <utility>

#include "roadbed/map/occupancy/clouds/local_origin.h"

namespace roadbed::map::inline occupancy::inline clouds {

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

}  // namespace roadbed::map::occupancy::clouds
