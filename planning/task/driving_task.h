#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/lateral/cost_terms.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/obstacles/other_levels.h"
#include "roadbed/planning/obstacles/reachable_set.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/reference/speed_ceiling.h"
#include "roadbed/planning/route/route.h"
#include "roadbed/planning/speed/timed_goal.h"
#include "roadbed/planning/task/stop_points.h"

namespace roadbed::planning::inline task {

/// Where to drive, and among what. All poses are in the map's frame.
struct DrivingTask {
  std::shared_ptr<const map::RoadMap> kept_map;
  const map::RoadMap& road_map = *kept_map;
  std::shared_ptr<const map::ClearanceField> field;  ///< of the occupancy; none without one
  geometry::Pose2 start;                             ///< of the ego's rear axle
  Route route;
  ReferenceLine line;
  ReferenceLineOptions line_options = {};  ///< that a route's line is drawn with
  OtherLevels other_levels = {};           ///< roads over and under the route
  std::vector<Obstacle> obstacles;         ///< motions last for the duration of the drive
  /// What is expected of others, who are measured; none: their future is known.
  std::optional<MotionBounds> others_within = {};
  std::optional<double> sight_m = {};       ///< how far others are seen; none: all are known
  std::optional<TimedGoal> goal = {};       ///< none: to stand at the end of the route
  std::vector<LightCycle> lights = {};      ///< what the traffic lights show
  std::vector<StopPoint> stop_points = {};  ///< on the route, by station
  /// To the goal too, from lanes beside the start that may be changed to there.
  std::vector<ReferenceLine> other_lines = {};
  std::vector<std::vector<StopPoint>> other_stop_points = {};  ///< on each other line
  std::vector<std::size_t> blockers = {};  ///< obstacles that the route leads past, another way
  std::vector<map::LaneId> missed = {};    ///< lanes that nobody let it change to, by another way

  /// Obstacles that are there at a time.
  std::vector<Obstacle> obstacles_at(double t_s) const {
    std::vector<Obstacle> there;
    for (const Obstacle& obstacle : obstacles) {
      if (obstacle.is_there(t_s)) there.push_back(obstacle);
    }
    return there;
  }
};

/// How the ego is to be driven.
struct DrivingOptions {
  double desired_speed_mps = 130.0 / 3.6;
  double max_lateral_acceleration_mps2 = 2.5;  ///< sets the speed in bends
  double comfort_acceleration_mps2 = 1.5;      ///< on a free road
  double comfort_deceleration_mps2 = 1.5;      ///< ahead of bends, limits, leads and the goal
  double clearance_m = 0.3;                    ///< to obstacles and occupied space
  double headway_s = 1.5;                      ///< kept behind a lead, besides the standstill gap
  double standstill_gap_m = 5.0;
  CostTerms weights = default_weights();  ///< of a candidate's cost
};

/// Greatest speeds along a line for a vehicle that is driven so.
inline SpeedCeiling ceiling_of(const ReferenceLine& line, const geometry::VehicleShape& vehicle,
                               const DrivingOptions& options) {
  return speed_ceiling(line, vehicle,
                       {.desired_speed_mps = options.desired_speed_mps,
                        .max_lateral_acceleration_mps2 = options.max_lateral_acceleration_mps2,
                        .deceleration_mps2 = options.comfort_deceleration_mps2});
}

}  // namespace roadbed::planning::task
