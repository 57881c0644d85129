#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/lateral/candidates.h"
#include "roadbed/planning/lateral/cost_terms.h"
#include "roadbed/planning/lateral/planned_speed.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/obstacles/prediction.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline lateral {

/// Defaults of one planning cycle; those of the weights are in README.md.
struct PlanOptions {
  double d_step_m = 0.1;  ///< paper: Δd
  double l_step_m = 0.2;  ///< paper: Δl
  double min_d_m = -3.5, max_d_m = 3.5;
  double min_l_m = 15.0, max_l_m = 30.0;
  int points = 31;           ///< per candidate
  int circles = 3;           ///< that cover the vehicle
  double clearance_m = 0.3;  ///< to keep from obstacles
  double max_lateral_acceleration_mps2 = 4.0;
  double border_margin_m = 0.0;  ///< to keep from the corridor's edges
  double recovery_m = 10.0;      ///< a start off the road or near an obstacle may mend over this
  double horizon_s = 5.0;        ///< moving obstacles are checked this far ahead
  /// A maneuver has to be completed within this, by a stop or by passing and returning
  /// (maneuver_completion.h); 0: it is not checked.
  double completion_horizon_s = 10.0;
  double completion_deceleration_mps2 = 3.0;  ///< of that stop
  bool limit_steering_rate = true;            ///< to what the vehicle's steering can do
  CostTerms weights = default_weights();
  bool keep_candidates = false;  ///< fill Plan::candidates, every one fully judged
  bool keep_stations = false;    ///< for PlanningCycle::judge(), which is quicker then
  bool exhaustive = false;       ///< evaluate even what cannot be the cheapest; same answer
};

/// What is kept clear beside the body.
struct SafetyMargins {
  double border_margin_m = 0.0;  ///< to the corridor's edges; below 0 the body may stick out so far
  double clearance_m = 0.3;      ///< to obstacles

  bool operator==(const SafetyMargins&) const = default;
};

inline SafetyMargins margins_of(const PlanOptions& options) {
  return {options.border_margin_m, options.clearance_m};
}

/// The question of one planning cycle.
struct PlanInput {
  LineView line;  ///< a ReferenceLine may be given
  LateralState start;
  double start_t_s = 0.0;  ///< scene time at the start, for obstacles' motions
  SpeedPlan speed;
  const std::vector<Obstacle>& obstacles;
  const map::ClearanceField* static_field = nullptr;  ///< none: no occupancy
  Eigen::Vector2d origin_in_source{0, 0};             ///< source = map + origin, for the field
  std::function<double(double)> previous_d_m = {};    ///< d of the last plan by s; may be empty
  std::span<const PredictedObstacle> predicted = {};  ///< besides `obstacles`
  std::span<const SpeedSample> speed_profile = {};    ///< if any, it stands in for `speed`
};

/// How many candidates were rejected, by Rejection.
using RejectionCounts = std::array<std::size_t, kRejections>;

/// What one planning cycle found. Having no candidate left is an answer, not an error.
struct Plan {
  std::optional<Candidate> chosen;
  LateralState start;                        ///< of the chosen candidate's quintic
  std::optional<geometry::Quintic> quintic;  ///< the chosen one
  geometry::Trajectory trajectory;    ///< the chosen drive over time; rear axle; empty if none
  std::vector<Candidate> candidates;  ///< the whole grid, d_e fastest, if asked for
  /// Of those that were looked at before the choice, each under one cause that it fails for; the
  /// first one in the order of Rejection if all candidates are kept. Some collide if, and only if,
  /// one does that could be driven but for obstacles.
  RejectionCounts rejected{};
  std::size_t evaluated = 0;  ///< candidates whose cost had to be computed
  std::string reason;         ///< counts per cause if nothing is feasible

  /// d, its slope and second derivative of the chosen quintic at a station of the line; past its
  /// end d stays. @pre chosen
  LateralState lateral_at(double s_m) const;

  /// Whether a candidate was rejected because it would collide: something is in the way, and a
  /// smaller margin to the road's edges will not help.
  bool meets_something() const;
};

/// @throws std::invalid_argument if an option or the start is not usable.
void check(const LateralState& start, const PlanOptions& options);
void check(const SafetyMargins& margins);

}  // namespace roadbed::planning::lateral
