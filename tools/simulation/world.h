#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/route.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/timed_goal.h"
#include "roadbed/tools/simulation/traffic_flow.h"
#include "roadbed/tools/simulation/waiting_places.h"
#include "roadbed/tools/support/inputs.h"

namespace roadbed::tools {

/// Seconds of the drive during which an obstacle is there.
struct Presence {
  double from_s = 0.0, to_s = 0.0;
};

/// What a scenario means: its files loaded, its places found, its obstacles set in motion. All
/// poses are in the map's frame.
struct World {
  std::shared_ptr<const map::RoadMap> kept_map;
  const map::RoadMap& road_map = *kept_map;
  std::shared_ptr<const map::OccupancyMap> occupancy;  ///< none where there is no file of it
  std::shared_ptr<const map::ClearanceField> field;    ///< of the occupancy
  geometry::Pose2 start;                               ///< of the ego's rear axle
  planning::Route route;
  planning::ReferenceLine line;
  std::vector<planning::Obstacle> obstacles;  ///< motions last for the scenario's duration
  std::vector<LaneDriver> drivers = {};       ///< of the obstacles that follow who is ahead
  std::vector<Presence> presence = {};        ///< one per obstacle; empty: always there
  std::optional<TimedGoal> goal = {};         ///< none: to stand at the end of the route
  /// To the goal too, from lanes beside the start that may be changed to there.
  std::vector<planning::ReferenceLine> other_lines = {};
  std::vector<WaitingPlace> waiting_places = {};                     ///< on the route, by station
  std::vector<std::vector<WaitingPlace>> other_waiting_places = {};  ///< on each other line
  double road_end_s_m = 1e9;  ///< station at which the lanes behind the goal end

  bool is_there(std::size_t obstacle, double t_s) const {
    return presence.empty() || (t_s >= presence[obstacle].from_s && t_s <= presence[obstacle].to_s);
  }

  /// Obstacles that are there at a time.
  std::vector<planning::Obstacle> obstacles_at(double t_s) const;
};

/// @throws InputError if a file is unusable, a place is not on the map, there is no route to the
///         goal, or an obstacle touches the ego at the start; it names the place in the scenario.
World make_world(const Scenario& scenario, const Inputs& inputs = Inputs());

}  // namespace roadbed::tools
