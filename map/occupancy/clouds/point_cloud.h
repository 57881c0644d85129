#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::map::inline occupancy::inline clouds {

/// What one step of a coordinate means, as far as the file says it.
enum class LengthUnit { unknown, metre, foot, us_survey_foot, degree };
std::string_view to_string(LengthUnit unit);

/// Points from `first` on were measured from here, until the next one of these.
struct ScanStart {
  std::size_t first = 0;
  std::optional<Eigen::Vector3d> sensor_in_source;  ///< none: it is not known from where
};

/// Measured points in the file's own coordinates, double, relative to a local origin.
///
/// The origin is 0 where every coordinate stays within 4096 of it, so that small clouds keep their
/// numbers bit for bit; else it is the middle of the bounds in whole units, per axis. A point in
/// the source is `origin_in_source + points[i]`.
struct PointCloud {
  std::string name;  ///< the file, as the user named it
  Eigen::Vector3d origin_in_source{0, 0, 0};
  std::vector<Eigen::Vector3f> points;  ///< relative to the origin [unit], all finite
  std::string format;                   ///< "PCD 0.7 binary", "LAS 1.2", …
  std::string crs;                      ///< as the file says, may be empty
  LengthUnit unit = LengthUnit::unknown;
  std::size_t dropped_not_finite = 0;
  std::size_t filtered_out = 0;
  std::optional<Eigen::Vector3d> sensor_in_source;  ///< of the file's viewpoint, if it names one
  std::vector<ScanStart> scans;  ///< in order, from point 0 on, where the file says of each point
                                 ///< where it was measured from; then `sensor_in_source` is unused
  /// Whether it stands in its sensor's own frame: where no sensor is said, ranges count from 0, 0,
  /// 0. Rays are not drawn from there, as nobody says where in the world it is.
  bool is_around_sensor = false;
  std::optional<std::int64_t> stamp_ns = {};        ///< when it was measured, if its log says so
  std::optional<std::int64_t> drive_start_ns = {};  ///< of the first pose of its log's drive
  std::vector<std::string> notes;                   ///< what the user may want to know of the file

  /// Whether rays can be drawn to some of its points.
  bool has_sensor() const { return sensor_in_source.has_value() || !scans.empty(); }
  /// A point in the source's coordinates.
  Eigen::Vector3d in_source(std::size_t i) const {
    return origin_in_source + points[i].cast<double>();
  }
};

/// Clouds that come one after the other, so that not all are in memory; the same each time.
using CloudsInTurn = std::function<void(const std::function<void(const PointCloud& cloud)>& use)>;

/// An axis-aligned box in source coordinates.
struct Box3 {
  Eigen::Vector3d min_in_source, max_in_source;

  /// Whether a point lies in the box or on it.
  bool holds(const Eigen::Vector3d& point) const {
    return (point.array() >= min_in_source.array()).all() &&
           (point.array() <= max_in_source.array()).all();
  }

  /// Grows to hold another box, too.
  void extend(const Box3& other) {
    min_in_source = min_in_source.cwiseMin(other.min_in_source);
    max_in_source = max_in_source.cwiseMax(other.max_in_source);
  }
};

/// Smallest box around all points. The cloud must hold one.
Box3 bounds(const PointCloud& cloud);

/// @throws InputError if the file says that its unit is another than the metre.
void check_is_in_metres(const PointCloud& cloud);

}  // namespace roadbed::map::occupancy::clouds
