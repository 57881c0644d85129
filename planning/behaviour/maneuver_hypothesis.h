#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "roadbed/planning/behaviour/goal_lines.h"
#include "roadbed/planning/behaviour/hypothesis_outcome.h"
#include "roadbed/planning/behaviour/lateral_replanner.h"
#include "roadbed/planning/behaviour/planner_types.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/reference/speed_ceiling.h"
#include "roadbed/planning/speed/path_profile.h"
#include "roadbed/planning/speed/speed_search.h"
#include "roadbed/planning/speed/st_graph.h"
#include "roadbed/planning/speed/timed_goal.h"
#include "roadbed/planning/task/stop_points.h"

namespace roadbed::planning::inline behaviour {

/// How much risk is taken: safety margin to obstacles, braking, speed in bends, and steering.
struct RiskLevel {
  double margin_m;
  SpeedSearchOptions speed;
  bool is_emergency;
  BendLimits bends = {};
  double most_lateral_mps2 = kUsualLateral_mps2;  ///< that the wheels may be turned for

  bool steers_hard() const { return most_lateral_mps2 > kUsualLateral_mps2; }
};

/// A path to ask the lateral planner for.
struct PathQuery {
  GoalLine* goal_line;
  Maneuver maneuver;
  LateralReplanner::Question question;
  LateralReplanner::Offsets offsets = {};
  bool may_leave_lanes = true;
  /// Without a candidate the path that is kept is not driven out of these offsets, either.
  bool bounds_kept_path = false;
};

/// One path, its profile, and the best drive found on it.
struct ManeuverHypothesis {
  GoalLine* goal_line;
  Maneuver maneuver;
  LateralReplanner::Proposal proposal;  ///< without a candidate: the path that is being driven
  PathProfile profile;
  double on_road_m;            ///< how far along the path the body keeps to the road
  bool by_cruise_law = false;  ///< the answer is what the cruise law is expected to do
  /// Who would be met by the cruise law, and when; none: nobody.
  struct Meeting {
    std::size_t obstacle;
    double after_s;
  };
  std::optional<Meeting> meeting = {};
  SpeedSearchAnswer answer = {};
  const RiskLevel* risk_level = nullptr;
  std::shared_ptr<const StGraph> occupancy = nullptr;  ///< with that safety margin
  double cost = 0.0;

  bool has_candidate() const { return proposal.plan.chosen.has_value(); }
};

/// What the search found asks the actuator for until the next cycle. @pre it was searched
inline double first_command_mps2(const ManeuverHypothesis& hypothesis) {
  const std::vector<SpeedState>& plan = hypothesis.answer.plan;
  return plan.size() > 1 ? plan[1].command_mps2 : hypothesis.risk_level->speed.least_mps2;
}

/// How far beside the reference line the path ends.
inline double beside_m(const ManeuverHypothesis& hypothesis) {
  return hypothesis.has_candidate() ? std::abs(hypothesis.proposal.plan.chosen->end_d_m) : 0.0;
}

/// Whether it meets nothing, and takes no bend faster than can be borne.
inline bool is_drivable(const ManeuverHypothesis& hypothesis) {
  constexpr double kBearable_mps = 0.3;  // beyond what a bend allows
  return hypothesis.answer.is_free && hypothesis.answer.bend_excess_mps <= kBearable_mps;
}

/// Whether nothing else need be tried: it is drivable, and does not miss the goal.
inline bool is_good(const ManeuverHypothesis& hypothesis) {
  return is_drivable(hypothesis) && !hypothesis.answer.misses_goal;
}

/// What is beyond the bends' limits is worse than what is within them, both reaching the goal or
/// both missing it; only a goal that is missed otherwise is worth it, by cost.
inline int rank_of(const ManeuverHypothesis& hypothesis) {
  if (is_good(hypothesis)) return 0;
  return is_drivable(hypothesis) || !hypothesis.answer.misses_goal ? 1 : 2;
}

/// Free before not free; then by rank, then by cost, or by how long it is free and how slow it is
/// by then.
inline bool is_better(const ManeuverHypothesis& a, const ManeuverHypothesis& b) {
  if (a.answer.is_free != b.answer.is_free) return a.answer.is_free;
  if (a.answer.is_free) {
    return rank_of(a) != rank_of(b) ? rank_of(a) < rank_of(b) : a.cost < b.cost;
  }
  if (a.answer.free_until_s != b.answer.free_until_s) {
    return a.answer.free_until_s > b.answer.free_until_s;
  }
  return a.answer.plan.back().speed_mps < b.answer.plan.back().speed_mps;
}

}  // namespace roadbed::planning::behaviour
