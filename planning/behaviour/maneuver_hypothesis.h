#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "roadbed/planning/behaviour/behaviour.h"
#include "roadbed/planning/behaviour/lateral_replanner.h"
#include "roadbed/planning/behaviour/path_profile.h"
#include "roadbed/planning/behaviour/speed_search.h"
#include "roadbed/planning/behaviour/st_graph.h"
#include "roadbed/planning/behaviour/stop_points.h"
#include "roadbed/planning/behaviour/timed_goal.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/reference/speed_ceiling.h"

namespace roadbed::planning::inline behaviour {

/// How much risk is taken: safety margin to obstacles, and braking.
struct RiskLevel {
  double margin_m;
  SpeedSearchOptions speed;
  bool is_emergency;
};

/// From the most careful on.
inline constexpr std::array<RiskLevel, 3> kRiskLevels{{
    {.margin_m = 0.4, .speed = {}, .is_emergency = false},
    {.margin_m = 0.4, .speed = {.least_mps2 = -8.0, .most_mps2 = 4.0}, .is_emergency = true},
    {.margin_m = 0.1, .speed = {.least_mps2 = -8.0, .most_mps2 = 4.0}, .is_emergency = true},
}};

/// One line to the goal, and the path that is kept along it.
struct GoalLine {
  const ReferenceLine& line;
  SpeedCeiling ceiling;
  std::vector<GoalStretch> stretches;
  std::vector<StopPoint> lights;
  LateralReplanner replanner;
};

/// One path, its profile, and the best drive found on it.
struct ManeuverHypothesis {
  const GoalLine* goal_line;
  std::optional<LateralReplanner::Proposal> proposal;  ///< none: the path that is being driven
  PathProfile profile;
  double on_road_m;  ///< how far along the path the body keeps to the road
  SpeedSearchAnswer answer;
  const RiskLevel* risk_level = nullptr;
  std::shared_ptr<const StGraph> occupancy = nullptr;  ///< with that safety margin
  double cost = 0.0;
  std::optional<DriveLead> lead;
};

/// How far beside the reference line the path ends.
inline double beside_m(const ManeuverHypothesis& hypothesis) {
  return hypothesis.proposal ? std::abs(hypothesis.proposal->plan.chosen->end_d_m) : 0.0;
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

/// Free before not free; then by cost, or by how long it is free and how slow it is by then.
inline bool is_better(const ManeuverHypothesis& a, const ManeuverHypothesis& b) {
  if (a.answer.is_free != b.answer.is_free) return a.answer.is_free;
  if (a.answer.is_free) return a.cost < b.cost;
  if (a.answer.free_until_s != b.answer.free_until_s) {
    return a.answer.free_until_s > b.answer.free_until_s;
  }
  return a.answer.plan.back().speed_mps < b.answer.plan.back().speed_mps;
}

}  // namespace roadbed::planning::behaviour
