#pragma once

#include <optional>
#include <vector>

#include "roadbed/planning/behaviour/decision.h"
#include "roadbed/planning/behaviour/maneuver_hypothesis.h"
#include "roadbed/planning/behaviour/planner_types.h"
#include "roadbed/planning/obstacles/traffic.h"
#include "roadbed/planning/right_of_way/lights_ahead.h"
#include "roadbed/planning/right_of_way/right_of_way.h"

namespace roadbed::planning::inline behaviour {

/// What all hypotheses of one cycle are judged against.
struct PlanningScene {
  const PlannerView& view;
  Traffic traffic;
  std::vector<bool> no_matter = {};  ///< per obstacle: it follows in the lane; empty: none does
  std::vector<bool> crosses = {};    ///< per obstacle: it moves across the line; empty: none does
  TrafficBodies bodies = {};         ///< for steps(): where they will be
  std::optional<StopConstraint> halt = {};  ///< that a rule of the road asks for
  double last_command_mps2 = 0.0;
  std::optional<double> most_mps = {};     ///< to come into a gap of the next lane
  std::vector<HiddenWalker> walkers = {};  ///< who may step out beside the path that is kept
};

/// Finds the speed along the path of a hypothesis, among all that moves.
class HypothesisSpeed {
 public:
  HypothesisSpeed(const PlannerSetup& setup, const DecisionOptions& cruise);

  double horizon_s(double t_s) const;
  int steps(double t_s) const;  ///< of 0.1 s, that the scene's bodies have to cover

  /// Length of the path ahead that a hypothesis' profile has to cover.
  double look_ahead_m(const PlannerView& view) const;

  /// What the cruise law will make of it; the answer is by that law.
  void forecast(const PlanningScene& scene, ManeuverHypothesis& hypothesis) const;

  /// The cheapest drive of the s–t graph.
  void search(const PlanningScene& scene, const RiskLevel& risk_level,
              ManeuverHypothesis& hypothesis) const;

  /// Whether some speed at that level could lead to the goal; see goal_reach.h.
  bool may_reach_goal(const PlanningScene& scene, const RiskLevel& risk_level,
                      const ManeuverHypothesis& hypothesis) const;

  /// What the search asks for, and why.
  PlannerCommand command_of(const ManeuverHypothesis& best, const PlanningScene& scene) const;

 private:
  bool goal_is_past(double t_s) const;
  std::vector<LightAhead> lights_ahead(const ManeuverHypothesis& hypothesis) const;
  void explain(const ManeuverHypothesis& best, const PlanningScene& scene,
               PlannerCommand& command) const;
  SpeedSearchQuestion question_of(const PlanningScene& scene, const ManeuverHypothesis& hypothesis,
                                  const StGraph& occupancy) const;
  double end_m(const PlanningScene& scene, const ManeuverHypothesis& hypothesis) const;
  void block_lights(const PlanningScene& scene, const ManeuverHypothesis& hypothesis,
                    StGraph& occupancy) const;
  void set_occupancy(const PlanningScene& scene, double margin_m,
                     ManeuverHypothesis& hypothesis) const;

  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  const DecisionOptions& cruise_;
};

}  // namespace roadbed::planning::behaviour
