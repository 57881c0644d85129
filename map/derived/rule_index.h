#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::map::inline derived {

/// What a RulePlace speaks of; `index` counts in the RoadMap's list of such things.
enum class RuleKind { signal, stop_line };

/// A signal or stop line that holds for a lane, and where along the lane it is passed.
struct RulePlace {
  RuleKind kind = RuleKind::signal;
  std::size_t index = 0;
  LaneId lane;
  double s_m = 0.0;         ///< of the lane; a signal that stands beyond its end is at the end
  double distance_m = 0.0;  ///< from where one asked, along the lanes
};

/// What holds at a place of a lane.
struct RulesAt {
  std::optional<double> speed_limit_mps;  ///< none: the source says nothing
  bool may_change_left = false, may_change_right = false;
  std::vector<std::size_t> regulations;  ///< indices of RoadMap::regulations() that hold there
  std::optional<RulePlace> next_signal, next_stop_line;  ///< on this lane, at or after the place
};

/// Answers which rules hold where. It refers to its map, which must outlive it.
class RuleIndex {
 public:
  /// O(signals + stop lines + regulations), times the points of the lanes that they speak to.
  explicit RuleIndex(const RoadMap& road_map);

  /// Of some lanes only; of others it says that no signal, stop line or regulation holds. Looks at
  /// no other lane.
  RuleIndex(const RoadMap& road_map, std::span<const LaneId> lanes);

  /// What holds at station `s_m` of a lane.
  RulesAt at(LaneId lane, double s_m) const;

  /// Signals and stop lines on the way along `path`, whose lanes follow each other: from station
  /// `from_s_m` of the first lane on, not further than `within_m`; nearest first.
  std::vector<RulePlace> ahead(std::span<const LaneId> path, double from_s_m,
                               double within_m) const;

 private:
  struct OfLane {
    std::vector<RulePlace> places;  ///< by station
    std::vector<std::size_t> regulations;
  };
  template <typename Wants>
  void add_all(const Wants& wants);
  void add(RulePlace place) { of_lane_[place.lane].places.push_back(place); }
  void sort_places();
  const OfLane& of(LaneId lane) const;

  const RoadMap* road_map_;
  std::map<LaneId, OfLane> of_lane_;  ///< of lanes for which something holds
};

}  // namespace roadbed::map::derived
