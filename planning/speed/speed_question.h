#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "roadbed/geometry/motion/longitudinal.h"
#include "roadbed/planning/speed/path_profile.h"
#include "roadbed/planning/speed/st_graph.h"
#include "roadbed/planning/speed/timed_goal.h"

namespace roadbed::planning::inline speed {

/// State and command of a plan at one time.
struct SpeedState {
  double t_s = 0.0;  ///< from now
  double ahead_m = 0.0, speed_mps = 0.0, acceleration_mps2 = 0.0, command_mps2 = 0.0;
};

/// The state after a command has been held for a while: the actuator follows it with a lag of the
/// first order (paper eq. 25), integrated exactly. Who has come to rest by then stays where that
/// was; a vehicle never reverses.
SpeedState followed(const SpeedState& from, double command_mps2, double for_s);

/// A goal as the search sees it: times from now, distances along the path.
struct GoalAhead {
  Window time_s, speed_mps, ahead_m;
  /// It counts only at time steps, `step_s` apart, one of them at `a_step_s`; 0: at any time.
  double step_s = 0.0, a_step_s = 0.0;
};

struct SpeedSearchQuestion {
  const PathProfile& profile;
  const StGraph& occupancy;
  double speed_mps = 0.0, acceleration_mps2 = 0.0;
  double last_command_mps2 = 0.0;
  double horizon_s = 5.0;
  double end_m = 0.0;            ///< of the path that may be driven; the vehicle stops before
  std::vector<GoalAhead> goals;  ///< reaching one of them is enough
  /// No speed on this path reaches the goal that is asked for: whatever is found misses it.
  bool goal_is_off_path = false;
  double most_wanted_mps = 1e3;  ///< beside what the path wants
};

struct SpeedSearchOptions {
  double least_mps2 = -geometry::kLongitudinal.max_command_mps2;
  double most_mps2 = geometry::kLongitudinal.max_command_mps2;
  double actuator_lag_s = geometry::kLongitudinal.actuator_lag_s;
};

struct SpeedSearchAnswer {
  bool is_free = false;          ///< nothing is touched up to the horizon, or up to the goal
  bool reaches_goal = false;     ///< within the horizon
  bool misses_goal = false;      ///< its time is over within the horizon, and it is not reached
  double free_until_s = 0.0;     ///< the last time up to which something untouched was found
  double bend_excess_mps = 0.0;  ///< largest speed beyond what the path's bends allow
  double cost = std::numeric_limits<double>::infinity();
  std::vector<SpeedState> plan;  ///< the cheapest found, or the one free the longest; not empty
};

}  // namespace roadbed::planning::speed
