#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline route {

/// Lists of one kind of thing, one behind the other in a single array: group i is
/// items[first[i]] … items[first[i + 1]].
template <typename T>
struct CsrLists {
  std::vector<std::uint32_t> first{0};
  std::vector<T> items;

  std::size_t groups() const { return first.size() - 1; }
  std::span<const T> of(std::size_t group) const {
    return {items.data() + first[group], items.data() + first[group + 1]};
  }
  /// What was appended to `items` since the last call becomes the next group.
  void end_list() { first.push_back(static_cast<std::uint32_t>(items.size())); }
};

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

/// O(points of the map).
RouteNetwork make_route_network(const map::RoadMap& road_map, const NetworkOptions& options = {});

/// Adds to a network of a map's lanes those that may be driven against their direction.
///
///        left            ◀─────── reversed ────        right
///     ───────▶ lane ───▶ ─────── two-way lane ▶ ───▶ lane
///
/// They have the map's links the other way round. Where borders meet head to head or
/// back to back a lane also leads over into one that is driven the other way: ends belong together
/// if both corners are within 5 cm. Lights are for the lane's own direction. O(N log N).
void add_contraflow_lanes(const map::RoadMap& road_map, const NetworkOptions& options,
                          RouteNetwork& network);

/// Finds for each lane of a network those beside it that are driven the same way, and where a
/// change to them is permitted. O(lanes).
void add_neighbours(const map::RoadMap& road_map, const NetworkOptions& options,
                    RouteNetwork& network);

/// A network as bytes: what `import` puts into a compiled map as its routing section, so that a
/// route is found without touching lanes that it does not use. Layout: README.md.
std::string write_route_network(const RouteNetwork& network);

/// None if the bytes are empty or of another version.
/// @throws std::invalid_argument if they are damaged, or not of so many lanes.
std::optional<RouteNetwork> read_route_network(std::string_view bytes, std::size_t lanes);

/// The network of a map: the one in its compiled form, else made now.
/// @throws InputError if the compiled map is damaged.
RouteNetwork route_network_of(const map::RoadMap& road_map);

}  // namespace roadbed::planning::route
