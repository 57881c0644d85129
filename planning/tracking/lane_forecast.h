#pragma once

#include <optional>
#include <span>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/obstacles/foreseen_motion.h"
#include "roadbed/planning/obstacles/lanes_ahead.h"
#include "roadbed/planning/tracking/tracker.h"

namespace roadbed::planning::inline tracking {

/// What an object may do, and how likely that is.
struct ForecastMotion {
  geometry::Trajectory motion;  ///< of its centre, in the map, from now on
  double probability = 1.0;
  std::vector<map::LaneId> lanes = {};  ///< that it drives along; empty: along none
};

/// Foresees objects one by one: who drives along a lane goes on along it, and where lanes part
/// along each of them; beside a lane's middle it comes back to it, but what is narrow. Others, and
/// who is on no lane, keep their bend for a while (foreseen_motion.h). Speeds are those of
/// foreseen_speed_mps().
///
///                     ╭──▶ 0.3     how likely: how well its heading and place fit the lane,
///     ──●─────────────┼──▶ 0.6     times, at each fork, how little that lane turns
///                     ╰──▶ 0.1     and how little it has to brake for that
///
/// Ways are kept from one time to the next.
class LaneForecast {
 public:
  /// Refers to the map.
  explicit LaneForecast(const map::RoadMap& road_map) : road_map_(road_map) {}

  static constexpr std::size_t kMostMotions = 3;

  using Tracks = std::span<const std::optional<Track>>;  ///< all slots of a tracker

  /// Of the track in a slot, by which its ways are kept. The most likely motion first; their
  /// probabilities make 1. A body that stands has one motion of one point.
  /// @param tracks  all slots of the tracker: who stands behind another one is in a queue.
  std::vector<ForecastMotion> motions(Tracks tracks, std::size_t slot);

 private:
  struct OnLane {
    map::LanePlace place;
    double turned_rad;  ///< its heading against the lane's
    double weight;
  };
  struct Way {
    LanesAhead ahead;
    geometry::Polyline centre;
    double weight;  ///< of its forks
  };
  struct Kept {
    double length_m = 0.0;
    std::vector<map::LaneId> from;
    std::vector<std::vector<Way>> ways;  ///< per lane of `from`
  };

  bool waits(Tracks tracks, const Track& track, const SeenMotion& seen) const;
  bool is_at_junction(const SeenMotion& seen) const;
  bool is_in_mid_lane(const SeenMotion& seen) const;
  std::vector<OnLane> lanes_at(const SeenMotion& seen) const;
  const Kept& ways_from(std::size_t slot, const std::vector<OnLane>& on, double length_m);
  std::vector<Way> new_ways(map::LaneId from, double length_m) const;
  double fork_weight(const LanesAhead& ahead) const;
  double slows_in_time(double speed_mps, const LanesAhead& ahead, double s_m) const;

  const map::RoadMap& road_map_;
  std::vector<Kept> kept_;  ///< per slot
};

}  // namespace roadbed::planning::tracking
