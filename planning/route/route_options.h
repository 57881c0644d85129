#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline route {

enum class RouteCost { time, distance };

/// What a route pays beside the way itself, in the unit of its cost: s or m.
struct ManoeuvrePrices {
  double lane_change = 0.0;  ///< each, where there is comfortable room
  double left_turn = 0.0;    ///< where there is a choice of ways and the lane turns by 30° or more
  double right_turn = 0.0;
  double u_turn = 0.0;  ///< by 150° or more
  double signal = 0.0;  ///< each traffic light that is passed
};

/// A stretch of a lane that nobody gets through, whichever way, by the lane's own stations. Before
/// and behind it the lane is driven: it may be left or entered there by a lane change.
struct BlockedStretch {
  map::LaneId lane;
  map::StationRange stations;
};
/// What is asked of a route.
struct RouteOptions {
  RouteCost cost = RouteCost::time;
  map::Participant participant = map::Participant::car;
  std::optional<double> default_speed_mps;  ///< instead of default_speed_mps(type) without a limit
  double max_speed_mps = 130.0 / 3.6;       ///< of the vehicle
  double lateral_acceleration_mps2 = 2.0;   ///< the most in bends
  ManoeuvrePrices prices_s{.lane_change = 5.0, .u_turn = 20.0};
  ManoeuvrePrices prices_m{.lane_change = 50.0, .u_turn = 200.0};
  double least_lane_change_m = 10.0;        ///< length that a lane change needs
  double comfortable_lane_change_m = 40.0;  ///< with less room its cost grows in proportion
  std::vector<map::LaneId> avoid;           ///< lanes that are closed
  /// Lanes that have one are not used for changes over several lane groups; within one lane group
  /// changes lead to one side, so that nobody changes out of a lane and back into it behind one.
  std::vector<BlockedStretch> blocked = {};
};

/// The length of a lane change from on which more of it makes it no cheaper [m].
double enough_room_m(const RouteOptions& options);

/// Speed where a map gives no limit, by the type of the lane [m/s]: 50 km/h, but 60 on ramps and
/// motorway entries and exits, 30 on lanes of both directions, 20 on biking lanes, 5 on sidewalks
/// and 10 on every other kind that is no road lane.
double default_speed_mps(map::LaneType type);

/// "car", "truck", …
std::string_view to_string(map::Participant kind);

/// Lanes whose area has a point in common with the region, in order of id: a closed region closes
/// them as a whole. O(lanes · points).
std::vector<map::LaneId> lanes_touching(const map::RoadMap& road_map,
                                        const geometry::Ring& region_in_map);

}  // namespace roadbed::planning::route
