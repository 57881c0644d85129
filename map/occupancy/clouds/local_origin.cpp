#include "roadbed/map/occupancy/clouds/cloud_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

constexpr double kNearZero = 4096.0;  // floats below it are exact to 0.25 mm

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

// Where floats stay near zero they are kept as they are.
void take_floats(std::vector<Eigen::Vector3f> points, PointCloud& cloud) {
  cloud.origin_in_source = local_origin(box_around(points));
  cloud.points = std::move(points);
  if (cloud.origin_in_source.isZero(0.0)) return;
  for (Eigen::Vector3f& point : cloud.points) {
    point = (point.cast<double>() - cloud.origin_in_source).cast<float>();
  }
}

void take_doubles(const std::vector<Eigen::Vector3d>& points, PointCloud& cloud) {
  cloud.origin_in_source = local_origin(box_around(points));
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

}  // namespace

Eigen::Vector3d local_origin(const Box3& box) {
  Eigen::Vector3d origin(0, 0, 0);
  for (int axis = 0; axis < 3; ++axis) {
    const double least = box.min_in_source[axis], most = box.max_in_source[axis];
    if (std::max(-least, most) > kNearZero) origin[axis] = std::round(0.5 * (least + most));
  }
  return origin;
}

PointCloud relative_to_origin(RawCloud raw) {
  PointCloud cloud;
  if (!raw.float_points_in_source.empty()) {
    take_floats(std::move(raw.float_points_in_source), cloud);
  } else if (!raw.empty()) {
    take_doubles(raw.points_in_source, cloud);
  }
  cloud.format = std::move(raw.format);
  cloud.crs = one_line(std::move(raw.crs));
  cloud.unit = raw.unit;
  cloud.is_around_sensor = raw.is_around_sensor;
  cloud.dropped_not_finite = raw.dropped_not_finite;
  cloud.filtered_out = raw.filtered_out;
  take_sensors(raw, cloud);
  cloud.notes = std::move(raw.notes);
  if (raw.without_sensor > 0) {
    cloud.notes.push_back(fmt::format("{} points have no finite sensor position: no rays to them",
                                      raw.without_sensor));
  }
  return cloud;
}

}  // namespace roadbed::map::occupancy::clouds
