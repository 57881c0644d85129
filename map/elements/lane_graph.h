#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/elements/id.h"
#include "roadbed/map/storage/lazy_list.h"

namespace roadbed::map::inline elements {

/// Part of a lane, by its stations.
struct StationRange {
  double from_s_m = 0.0, to_s_m = 0.0;
  bool operator==(const StationRange&) const = default;
};

/// A lane beside another one, and where the marking between them may be crossed.
struct Neighbour {
  LaneId lane;
  bool same_direction = true;
  std::vector<StationRange> change_windows;  ///< stations of the lane that is left; in order, apart

  bool change_allowed() const { return !change_windows.empty(); }
};

/// What one lane leads to.
struct LaneLinks {
  std::vector<LaneId> successors;    ///< lanes that begin where this one ends
  std::vector<LaneId> predecessors;  ///< lanes that end where this one begins
  std::optional<Neighbour> left;     ///< the next lane across the left border
  std::optional<Neighbour> right;
};

/// How lanes connect. Links of lanes that a car may not drive on are there too.
class LaneGraph {
 public:
  LaneGraph() = default;

  /// @param links  one per lane, in order of LaneId.
  /// @throws std::invalid_argument if a link names a lane that is not there.
  explicit LaneGraph(std::vector<LaneLinks> links) : links_(std::move(links)) { check(); }

  /// The same, unchecked: for links that check themselves when they are made.
  explicit LaneGraph(LazyList<LaneLinks> links) : links_(std::move(links)) {}

  /// @throws std::invalid_argument if a link names a lane that is not there.
  void check() const {
    for (const LaneLinks& of_lane : links_) {
      for (const LaneId id : of_lane.successors) check(id);
      for (const LaneId id : of_lane.predecessors) check(id);
      if (of_lane.left) check(of_lane.left->lane);
      if (of_lane.right) check(of_lane.right->lane);
    }
  }

  std::size_t size() const { return links_.size(); }
  const LaneLinks& of(LaneId lane) const { return links_.at(lane.index); }  ///< a lane's

 private:
  void check(LaneId id) const {
    if (id.index < links_.size()) return;
    throw std::invalid_argument("LaneGraph: a link names lane " + std::to_string(id.index) +
                                " of " + std::to_string(links_.size()));
  }

  LazyList<LaneLinks> links_;
};

}  // namespace roadbed::map::elements
