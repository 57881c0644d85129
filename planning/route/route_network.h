#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/route/csr_lists.h"

namespace roadbed::planning::inline route {

inline constexpr std::uint32_t kNoLane = 0xffffffffU;

/// Which way a lane turns where there is a choice of ways: in a junction or at a fork.
enum class Turn : std::uint8_t { none, straight, left, right, u_turn };

/// Part of a lane, up to a station, over which limit and bend are the same.
struct SpeedPiece {
  double to_s_m = 0.0;
  double limit_mps = 0.0;        ///< 0: the map says nothing
  double curvature_per_m = 0.0;  ///< greatest magnitude; 0 where it slows nobody down
};

/// What routing knows of a lane driven one way.
struct NetworkLane {
  double length_m = 0.0;
  Eigen::Vector2d start_in_map{0, 0}, end_in_map{0, 0};
  map::Participants users;  ///< who may drive along it, by its type too
  map::LaneType type = map::LaneType::driving;
  Turn turn = Turn::none;
  double signal_s_m = -1.0;                       ///< station of its light; negative: there is none
  std::uint32_t left = kNoLane, right = kNoLane;  ///< neighbours of the same direction
  std::uint32_t contraflow_twin = kNoLane;        ///< the same lane driven against its direction
};

/// The lanes of a map as flat arrays: all that routing needs. First stand the map's lanes by their
/// index, then once more those that may be driven against their direction, with everything as it is
/// seen when they are.
struct RouteNetwork {
  std::vector<NetworkLane> lanes;
  CsrLists<std::uint32_t> successors;
  CsrLists<SpeedPiece> speeds;
  CsrLists<map::StationRange> left_windows, right_windows;  ///< where a change is permitted

  bool is_reversed(std::uint32_t lane) const { return lanes[lane].contraflow_twin < lane; }
  /// The lane of the map.
  map::LaneId on_map(std::uint32_t lane) const {
    return {is_reversed(lane) ? lanes[lane].contraflow_twin : lane};
  }
  /// A station of the map's lane as one in driving direction, or the other way round.
  double mirrored_m(std::uint32_t lane, double s_m) const {
    return is_reversed(lane) ? lanes[lane].length_m - s_m : s_m;
  }
  /// @pre the lane may be driven that way.
  std::uint32_t lane_of(map::LaneId on_map, bool reversed) const {
    return reversed ? lanes[on_map.index].contraflow_twin : on_map.index;
  }
};

struct NetworkOptions {
  bool across_markings = false;  ///< every marking between lanes of one direction may be crossed
  bool against_traffic = false;  ///< links and neighbours lead both ways
};

/// Whether a route for that kind of road user may lead along the lane: its participants have to
/// hold the kind, and vehicles keep off shoulders, stops and parking places.
bool may_use(const map::Lane& lane, map::Participant kind);

/// Whether it may lead along it against its direction, too: on lanes of both directions, and for
/// pedestrians on the sidewalks of roads.
bool may_reverse(const map::Lane& lane, map::Participant kind);

/// Which way a lane turns from its first metre to its last.
Turn bend_of(const map::Lane& lane);

}  // namespace roadbed::planning::route
