#pragma once

#include <compare>
#include <cstddef>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::sumo {

/// A lane, driven in its direction or against it, as those that are open both ways may be.
struct DirectedLane {
  LaneId lane;
  bool against = false;
  auto operator<=>(const DirectedLane&) const = default;
};

/// All ways in which the lanes of a map are driven, and which lead on to which.
class DirectedLanes {
 public:
  explicit DirectedLanes(const RoadMap& road_map);

  /// Who drives so; nobody where it is not allowed, or the lane has no length or width.
  Participants users(DirectedLane way) const { return users_[place(way)]; }
  bool has(DirectedLane way) const { return !users(way).empty(); }  ///< whether anybody does
  /// The ways that begin where this one ends, for some of its users.
  const std::vector<DirectedLane>& next(DirectedLane way) const { return next_[place(way)]; }

  /// The ways that end where this one begins.
  const std::vector<DirectedLane>& before(DirectedLane way) const { return before_[place(way)]; }

 private:
  static std::size_t place(DirectedLane way) { return 2 * way.lane.index + (way.against ? 1 : 0); }
  void lead(DirectedLane from, DirectedLane to);
  void join_corners(const RoadMap& road_map);

  std::vector<Participants> users_;
  std::vector<std::vector<DirectedLane>> next_, before_;
};

/// Width of a lane on average [m].
double mean_width_m(const Lane& lane);

Participants both(Participants a, Participants b);  ///< those in both sets

}  // namespace roadbed::map::sumo
