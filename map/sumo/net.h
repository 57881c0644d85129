#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/sumo/directed_lanes.h"

namespace roadbed::map::sumo {

/// Where edges begin and end.
struct NetNode {
  std::string id;
  Eigen::Vector3d in_map{0, 0, 0};  ///< amid the ends of its edges [m]
  bool is_zipper = false;           ///< two lanes of an edge end in one of the next
};

/// Lanes side by side that are driven the same way, from the kerb to the middle of the road, as
/// SUMO counts them: from right to left, in left-hand traffic from left to right. lanes[i] has
/// index i.
struct NetEdge {
  std::string id;
  std::vector<DirectedLane> lanes;
  std::uint32_t from = 0, to = 0;           ///< nodes
  double from_share = 0.0, to_share = 1.0;  ///< the part of the lanes that it has
};

/// From a lane to a lane across a node.
struct NetConnection {
  std::uint32_t from = 0, to = 0;  ///< edges
  std::uint32_t from_lane = 0, to_lane = 0;
  std::vector<DirectedLane> across;  ///< lanes inside the junction, in order
  bool has_change = false;           ///< and from one of them to the next beside it
  Participants users;
};

/// A road map as SUMO sees it.
struct Net {
  std::vector<NetNode> nodes;
  std::vector<NetEdge> edges;
  std::vector<NetConnection> connections;  ///< by edge and lane that they leave
  bool left_hand = false;                  ///< traffic

  DirectedLane from_lane(const NetConnection& connection) const {
    return edges[connection.from].lanes[connection.from_lane];
  }
  DirectedLane to_lane(const NetConnection& connection) const {
    return edges[connection.to].lanes[connection.to_lane];
  }
  DirectedLane leftmost(const NetEdge& edge) const {
    return left_hand ? edge.lanes.front() : edge.lanes.back();
  }
  DirectedLane rightmost(const NetEdge& edge) const {
    return left_hand ? edge.lanes.back() : edge.lanes.front();
  }
};

/// Groups lanes into edges, leads connections across what lies between, joins ends in nodes.
Net build_net(const RoadMap& road_map, const DirectedLanes& ways,
              const std::vector<Conflict>& conflicts);

/// Edges, without nodes: of lanes that are not inside a junction; and of those inside that lead
/// from or to nowhere, as at the rim of a map, the first or last metre.
/// @param inner  by LaneId, see find_inner_lanes().
/// @param left_hand  whether traffic is: on which side the lanes begin to count.
std::vector<NetEdge> make_edges(const RoadMap& road_map, const DirectedLanes& ways,
                                const std::vector<std::optional<std::uint32_t>>& inner,
                                bool left_hand);

/// The shortest way inside the junction from each lane of an edge to each lane that it leads to,
/// with lane changes where the map allows them.
std::vector<NetConnection> make_connections(const RoadMap& road_map, const DirectedLanes& ways,
                                            const std::vector<std::optional<std::uint32_t>>& inner,
                                            const std::vector<NetEdge>& edges);

/// A name that SUMO takes and nothing else has yet: letters, digits and ". / + -", others as "-".
class NetIds {
 public:
  std::string give(std::string_view wanted);

 private:
  std::map<std::string, int> taken_;
};

}  // namespace roadbed::map::sumo
