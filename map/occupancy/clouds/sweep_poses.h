#pragma once

// Private to map/occupancy.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/map/logs/log_poses.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// Where a sensor was while it swept, for a point at a time: poses of each millisecond, and between
/// two of them straight on, which at 2 rad/s is off by less than 1e-6 rad.
class SweepPoses {
 public:
  /// Of a place in the world: `leftCols<3>() * in_sensor + col(3)`.
  using Placing = Eigen::Matrix<double, 3, 4>;

  static constexpr double kFarthest_ns = 1e9;  ///< from the sweep's stamp

  SweepPoses(PoseAt pose_at, std::int64_t stamp_ns);

  /// At the stamp itself; none where the pose is not known.
  const std::optional<Placing>& at_stamp() const { return at_stamp_; }

  /// At a time since the stamp. @pre it is within kFarthest_ns.
  std::optional<Placing> at(double since_stamp_ns);

 private:
  const std::optional<Placing>& at_knot(std::size_t i);
  std::optional<Placing> known_at(std::int64_t stamp_ns) const;

  PoseAt pose_at_;
  std::int64_t stamp_ns_;
  std::optional<Placing> at_stamp_;
  std::vector<std::optional<std::optional<Placing>>> knots_;  // empty: not asked for yet
};

}  // namespace roadbed::map::occupancy::clouds
