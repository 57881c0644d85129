#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "roadbed/map/sumo/lane_lines.h"
#include "roadbed/map/sumo/net.h"

namespace roadbed::map::sumo {

/// Which connections of a net get in each other's way.
class ConnectionConflicts {
 public:
  ConnectionConflicts(const Net& net, const std::vector<Conflict>& conflicts);

  /// Whether their lanes overlap or they end in one lane; not if they leave one lane.
  bool meet(std::uint32_t a, std::uint32_t b) const;

  /// The connections across each node.
  const std::vector<std::vector<std::uint32_t>>& at_nodes() const { return at_nodes_; }

 private:
  const Net& net_;
  std::vector<std::pair<LaneId, LaneId>> lanes_;  // that overlap, sorted
  std::vector<std::vector<std::uint32_t>> at_nodes_;
};

/// Pairs of edges, from and to: who waits for whom.
struct Prohibition {
  std::uint32_t first_from, first_to;  ///< has the right of way
  std::uint32_t then_from, then_to;
  auto operator<=>(const Prohibition&) const = default;
};

/// How far a connection turns to the left, negative to the right, in (−π, π].
double turn_rad(const RoadMap& road_map, const Net& net, const NetConnection& connection);

/// Connections that meet and of which the map says that one gives way to the other, as OpenDRIVE's
/// junctions and Lanelet2's right_of_way do; what it says both ways is left out. Where it says
/// nothing, turns across the oncoming traffic wait for it, and one of two such turns that meet.
/// O(pairs of connections across a node).
/// @throws InputError if there are more of these than a map of its size may have (work_limit.h).
std::vector<Prohibition> find_prohibitions(const RoadMap& road_map, const Net& net,
                                           const LaneLines& lines,
                                           const ConnectionConflicts& conflicts);

}  // namespace roadbed::map::sumo
