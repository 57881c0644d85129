#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "roadbed/map/occupancy/clouds/point_cloud.h"
#include "roadbed/map/occupancy/objects/found_objects.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/tracking/object_follower.h"

namespace roadbed::tools::inline audit {

/// When clouds were measured, in seconds of the drive that they are of.
class CloudClock {
 public:
  /// When the drive of a log begins, if that is known.
  using StartOfLog = std::function<std::optional<std::int64_t>()>;

  /// @param start_of_log  asked once, where clouds have stamps and do not say it; none: time 0 is
  ///                      that of the first cloud.
  /// @param period_s      from one cloud to the next, where they have no stamps.
  CloudClock(StartOfLog start_of_log, double period_s)
      : start_of_log_(std::move(start_of_log)), period_s_(period_s) {}

  /// @throws InputError if it is not later than that of the cloud before.
  double time_s(const map::PointCloud& cloud);

 private:
  double since_start_s(const map::PointCloud& cloud);

  StartOfLog start_of_log_;
  std::optional<std::int64_t> start_ns_;
  double period_s_, time_s_ = 0.0;
  std::size_t count_ = 0;
};

/// Obstacles of clouds that come one after the other in time: found in each of them
/// (map/occupancy/objects), followed from one to the next (planning/tracking).
class ObstacleFinder {
 public:
  /// @param threads  of which each takes a cloud; the answer is the same for any number.
  ObstacleFinder(const map::ObjectOptions& options, CloudClock clock, int threads);

  /// Takes the next cloud, which holds a point. May keep it, with one for each thread.
  void take(map::PointCloud cloud);

  /// All that was found.
  std::vector<planning::ObstacleInSource> obstacles();

  std::size_t clouds() const { return clouds_; }  ///< how many were taken
  std::size_t points() const { return points_; }  ///< in all of them

 private:
  void find_in_waiting();

  map::ObjectOptions options_;
  CloudClock clock_;
  int threads_;
  std::vector<map::PointCloud> waiting_;
  planning::ObjectFollower follower_;
  std::size_t clouds_ = 0, points_ = 0;
};

}  // namespace roadbed::tools::audit
