#pragma once

#include <vector>

#include "roadbed/map/road_map.h"
#include "roadbed/planning/route.h"

namespace roadbed::planning {

/// Which rules a search leaves out, to find out what stands in the way.
struct Leniency {
  bool closed_lanes = false, markings = false, length = false;
};

/// The rules and costs of travel, shared by the search and its explanation.
class TravelRules {
 public:
  TravelRules(const map::RoadMap& road_map, const RouteOptions& options, Leniency leniency);

  /// Whether a route may enter the lane.
  bool may_enter(map::LaneId lane) const { return open_[lane.index]; }

  /// Whether a route may change from a lane to its neighbour, `changes` others having been made in
  /// the same passage, `share` of which there is.
  bool may_change(map::LaneId from, const map::Neighbour& to, int changes, double share) const;

  /// Whether a passage of that share has room for so many changes that end in the lane.
  bool has_room(map::LaneId lane, int changes, double share) const;

  double travel_cost(map::LaneId lane, double share) const;
  double change_cost(map::LaneId from, int changes, double share) const;

  const map::RoadMap& road_map() const { return road_map_; }

 private:
  const map::RoadMap& road_map_;
  const RouteOptions& options_;
  Leniency leniency_;
  std::vector<bool> open_;
};

/// Speed at which a lane is driven [m/s].
double route_speed_mps(const map::Lane& lane, const RouteOptions& options);

}  // namespace roadbed::planning
