#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline speed {

/// A range of numbers; unbounded where nothing is asked.
struct Window {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool holds(double value) const { return value >= least && value <= most; }
};

/// One way to reach a goal: all of it at the same time step.
struct GoalState {
  Window time_s, speed_mps;
  std::optional<Window> heading_rad;        ///< any turn by 2π fits too
  map::commonroad::Shape region_in_source;  ///< empty with no lanes: anywhere
  std::vector<map::LaneId> lanes;
  bool is_anywhere() const { return region_in_source.empty() && lanes.empty(); }
};

/// Where on a reference line the place of a goal state is met, for the rear axle of a vehicle that
/// follows it; and its heading, too, where any offset meets both.
struct GoalStretch {
  Window time_s, speed_mps;
  Window s_m = {};
  double d_m = 0.0;  ///< beside the line, of the offsets that cross the region the least
};

/// The goal of a CommonRoad planning problem: reaching one of its states is enough, at one of the
/// scenario's time steps, with the vehicle's centre. No state at all can never be reached.
struct TimedGoal {
  double step_s = 0.1;
  std::vector<GoalState> states;

  /// Last time at which it can be reached; none: never.
  std::optional<double> latest_s() const;

  bool is_reached(const map::RoadMap& road_map, const geometry::Pose2& map_from_vehicle,
                  double speed_mps, double t_s, const geometry::VehicleShape& vehicle) const;
};

/// Stretches of the line, or of one beside it, on which states of the goal can be met. A state
/// whose region is more than 2 m beside the line has none; one without a region has the whole line.
/// That is what to aim at; whether a path meets a goal says goals_on_path.h.
std::vector<GoalStretch> goal_stretches(const TimedGoal& goal, const map::RoadMap& road_map,
                                        const ReferenceLine& line,
                                        const geometry::VehicleShape& vehicle);

/// Whether a heading, turned by any multiple of 2π, is within a window.
bool holds_heading(const Window& window, double heading_rad);

/// Whether a vehicle's centre is where a state wants it.
bool is_at_place(const GoalState& state, const map::RoadMap& road_map,
                 const Eigen::Vector2d& centre_in_map);

/// Whether a point lies in one of the shapes.
bool contains(const map::commonroad::Shape& shape, const Eigen::Vector2d& point);

/// Middle of the box around a shape. @pre not empty
Eigen::Vector2d middle_of(const map::commonroad::Shape& shape);

}  // namespace roadbed::planning::speed
