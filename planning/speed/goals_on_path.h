#pragma once

#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/speed/path_profile.h"
#include "roadbed/planning/speed/speed_search.h"
#include "roadbed/planning/speed/timed_goal.h"

namespace roadbed::planning::inline speed {

/// Where along a path the vehicle itself is as a goal asks: its centre in the region, its heading
/// in the window, at each place of the path with the path's own offset and heading. Each stretch is
/// one entry, of times from `now_s` on; none: no speed on this path reaches the goal.
///
/// Aims inside, so that what the tracking errs by costs nothing: by 0.25 m to the sides, 0.3 m
/// along, 0.05 rad and 0.2 m/s, less where a window is narrow; a path that meets a state with less
/// room than that counts only where none meets it with it.
std::vector<GoalAhead> goals_on_path(const TimedGoal& goal, const map::RoadMap& road_map,
                                     const PathProfile& profile, double now_s);

/// What a search for the speed on a path is to reach.
struct PathGoals {
  std::vector<GoalAhead> goals;
  bool is_off_path = false;  ///< no speed on this path reaches the goal
};

/// Where the path meets the goal. Where it meets it nowhere, the stretches of its line are aimed
/// at; that misses the goal, unless one is 60 m ahead or more, so that a later path can still lead
/// there.
PathGoals path_goals(const TimedGoal& goal, const map::RoadMap& road_map,
                     const std::vector<GoalStretch>& stretches, const PathProfile& profile,
                     double now_s);

}  // namespace roadbed::planning::speed
