#pragma once

// Private to map/occupancy.

#include <cmath>
#include <optional>
#include <string>

#include "roadbed/map/logs/cloud_message.h"
#include "roadbed/map/occupancy/clouds/cloud_formats.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// How a field of a PointCloud2 message is written.
ScalarType scalar_of(const PointField& field);

/// When each point of a PointCloud2 message was measured, by whichever of the fields `t` (Ouster),
/// `time` (Velodyne), `timestamp` (Hesai, Livox), `time_stamp` (Autoware), `offset_time` (Livox,
/// whole nanoseconds) and `timeOffset` (seconds) it has.
class PointTime {
 public:
  static std::optional<PointTime> of(const CloudMessage& message);

  /// A field that may hold times and is not taken, as its unit is not known: `curvature` (LOAM) or
  /// `T`, say; empty where there is none, or times are known.
  static std::string untaken_field(const CloudMessage& message);

  /// Of the point at `bytes`; may be not finite.
  double since_stamp_ns(const char* bytes) const {
    const double value = read_scalar(bytes + offset_, type_, is_big_endian_);
    const double magnitude = std::abs(value);
    constexpr double most_since_stamp = 1e8;  // of seconds; beyond, it is the time since 1970
    if (is_whole_) return value;              // of 32 bits: never since 1970
    if (magnitude < most_since_stamp) return 1e9 * value;
    return value * ns_of_unit(magnitude) - stamp_ns_;
  }

 private:
  // Times since 1970 in seconds, milliseconds, microseconds or nanoseconds lie far apart.
  static double ns_of_unit(double since_1970) {
    if (since_1970 < 1e11) return 1e9;
    if (since_1970 < 1e14) return 1e6;
    return since_1970 < 1e17 ? 1e3 : 1.0;
  }

  std::size_t offset_ = 0;
  ScalarType type_ = ScalarType::f32;
  bool is_whole_ = false, is_big_endian_ = false;
  double stamp_ns_ = 0.0;
};

}  // namespace roadbed::map::occupancy::clouds
