#pragma once

#include <memory>

#include "roadbed/map/model/road_map.h"

namespace roadbed::tests {

/// Whether a lane, driven in its direction or against it, leads to another one, driven so: by the
/// map's links, or where both are driven differently and their borders end in the same points.
bool leads_to(const map::RoadMap& road_map, map::LaneId lane, bool against, map::LaneId next,
              bool next_against);

/// Least length between places of a map without lane changes, by Boost.Graph's Dijkstra over lanes
/// and both of their directions, straight from the map: one direction follows another one where
/// the map links them so, or where borders end in the same points. An oracle: O(lanes²) to make.
class TwoWayOracle {
 public:
  /// Who may drive is asked of the map, for one kind of road user.
  TwoWayOracle(const map::RoadMap& road_map, map::Participant user);
  ~TwoWayOracle();

  /// [m]; infinite where no way leads. Either direction of both lanes will do.
  double length_m(const map::LanePlace& from, const map::LanePlace& to);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbed::tests
