#include "roadbed/map/occupancy/clouds/cloud_transforms.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "roadbed/map/occupancy/clouds/cloud_formats.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

/// Points in a row that were measured from one place.
struct Scan {
  std::size_t first, last;  // without the last one
  std::optional<Eigen::Vector3d> sensor_in_source;
};

std::vector<Scan> scans_of(const PointCloud& cloud) {
  if (cloud.scans.empty()) return {{0, cloud.points.size(), cloud.sensor_in_source}};
  std::vector<Scan> scans;
  for (const ScanStart& start : cloud.scans) {
    if (!scans.empty()) scans.back().last = start.first;
    scans.push_back({start.first, cloud.points.size(), start.sensor_in_source});
  }
  return scans;
}

PointCloud without_points(const PointCloud& cloud) {
  return {.name = cloud.name,
          .origin_in_source = cloud.origin_in_source,
          .points = {},
          .format = cloud.format,
          .crs = cloud.crs,
          .unit = cloud.unit,
          .sensor_in_source = {},
          .scans = {},
          .is_around_sensor = cloud.is_around_sensor,
          .notes = {}};
}

Box3 box_around(const PointCloud& cloud, const Scan& scan) {
  Box3 box{cloud.in_source(scan.first), cloud.in_source(scan.first)};
  const auto add = [&box](const Eigen::Vector3d& point) {
    box.min_in_source = box.min_in_source.cwiseMin(point);
    box.max_in_source = box.max_in_source.cwiseMax(point);
  };
  for (std::size_t i = scan.first + 1; i < scan.last; ++i) add(cloud.in_source(i));
  if (scan.sensor_in_source) add(*scan.sensor_in_source);
  return box;
}

class Cutter {
 public:
  Cutter(const PointCloud& cloud, const Eigen::Vector3d& origin_in_source, double side_m)
      : cloud_(cloud), origin_in_source_(origin_in_source), side_m_(side_m) {}

  std::vector<PointCloud> cut() {
    for (const Scan& scan : scans_of(cloud_)) {
      if (scan.first == scan.last) continue;
      scan.sensor_in_source ? add_scan(scan) : add_points(scan);
    }
    for (auto* pieces : {&of_points_, &of_scans_}) {
      for (auto& [place, piece] : *pieces) pieces_.push_back(std::move(piece));
    }
    return std::move(pieces_);
  }

 private:
  using Place = std::array<std::int64_t, 3>;

  Place place_of(const Eigen::Vector3d& in_source, double side_m) const {
    const Eigen::Vector3d cubes = (in_source - origin_in_source_) / side_m;
    const auto whole = [](double x) { return static_cast<std::int64_t>(std::floor(x)); };
    return {whole(cubes.x()), whole(cubes.y()), whole(cubes.z())};
  }

  void add_points(const Scan& scan) {
    for (std::size_t i = scan.first; i < scan.last; ++i) {
      of_points_.try_emplace(place_of(cloud_.in_source(i), side_m_), without_points(cloud_))
          .first->second.points.push_back(cloud_.points[i]);
    }
  }

  // Scans whose middles lie in one cube of half the side, and that reach no farther than it is
  // long.
  void add_scan(const Scan& scan) {
    const Box3 box = box_around(cloud_, scan);
    if ((box.max_in_source - box.min_in_source).maxCoeff() > 0.5 * side_m_) {
      append(scan, pieces_.emplace_back(without_points(cloud_)));
      return;
    }
    const Place place = place_of(0.5 * (box.min_in_source + box.max_in_source), 0.5 * side_m_);
    append(scan, of_scans_.try_emplace(place, without_points(cloud_)).first->second);
  }

  void append(const Scan& scan, PointCloud& piece) const {
    piece.scans.push_back({piece.points.size(), scan.sensor_in_source});
    piece.points.insert(piece.points.end(),
                        cloud_.points.begin() + static_cast<std::ptrdiff_t>(scan.first),
                        cloud_.points.begin() + static_cast<std::ptrdiff_t>(scan.last));
  }

  const PointCloud& cloud_;
  Eigen::Vector3d origin_in_source_;
  double side_m_;
  std::map<Place, PointCloud> of_points_, of_scans_;
  std::vector<PointCloud> pieces_;
};

}  // namespace

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
  moved.is_around_sensor = false;
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
  scaled.filtered_out = cloud.filtered_out;
  if (cloud.sensor_in_source) scaled.sensor_in_source = *cloud.sensor_in_source * factor;
  scaled.scans = cloud.scans;
  for (ScanStart& scan : scaled.scans) {
    if (scan.sensor_in_source) *scan.sensor_in_source *= factor;
  }
  scaled.is_around_sensor = cloud.is_around_sensor;
  scaled.stamp_ns = cloud.stamp_ns;
  scaled.drive_start_ns = cloud.drive_start_ns;
  scaled.notes = cloud.notes;
  return scaled;
}

std::vector<PointCloud> split_cloud(const PointCloud& cloud,
                                    const Eigen::Vector3d& origin_in_source, double side_m) {
  return Cutter(cloud, origin_in_source, side_m).cut();
}

}  // namespace roadbed::map::occupancy::clouds
