#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/map/logs/log_poses.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// Points in the order of their message, coordinate by coordinate, so that loops over them
/// vectorise.
struct PointRun {
  static constexpr std::size_t kMost = 512;
  using Values = std::array<double, kMost>;

  std::size_t count = 0;
  std::array<Values, 3> at;  ///< x, y and z, in the sensor's frame
  Values since_stamp_ns{};   ///< of the message
};

/// The same, placed in the world, and where the sensor was.
struct PlacedRun {
  std::size_t count = 0;
  std::array<PointRun::Values, 3> at, sensor;
};

/// Where a sensor was while it swept: poses of each millisecond, and between two of them straight
/// on, which at 2 rad/s is off by less than 1e-6 rad.
class SweepPoses {
 public:
  static constexpr double kFarthest_ns = 1e9;  ///< from the sweep's stamp

  SweepPoses(PoseAt pose_at, std::int64_t stamp_ns);

  /// Whether the pose at the stamp itself is known.
  bool knows_stamp() const { return known_at(0.0).has_value(); }

  /// Places those whose pose is known, each at its time. @pre times are within kFarthest_ns.
  void place(const PointRun& points, PlacedRun& placed);

 private:
  // Of a place in the world: `leftCols<3>() * in_sensor + col(3)`.
  using Placing = Eigen::Matrix<double, 3, 4>;

  const std::optional<Placing>& at_knot(std::size_t i);
  std::optional<Placing> known_at(double since_stamp_ns) const;

  PoseAt pose_at_;
  std::int64_t stamp_ns_;
  std::vector<std::optional<std::optional<Placing>>> knots_;  // empty: not asked for yet
};

}  // namespace roadbed::map::occupancy::clouds
