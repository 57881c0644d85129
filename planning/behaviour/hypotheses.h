#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "roadbed/planning/behaviour/cruise_law.h"
#include "roadbed/planning/behaviour/goal_lines.h"
#include "roadbed/planning/behaviour/hypothesis_outcome.h"
#include "roadbed/planning/behaviour/hypothesis_speed.h"
#include "roadbed/planning/behaviour/maneuver_hypothesis.h"
#include "roadbed/planning/behaviour/path_queries.h"

namespace roadbed::planning::inline behaviour {

/// The hypotheses of a cycle, one after the other until one is good.
class Hypotheses {
 public:
  /// @param lines, speed  outlive it.
  Hypotheses(const PlannerSetup& setup, GoalLines& lines, const HypothesisSpeed& speed)
      : vehicle_(setup.vehicle), task_(setup.task), lines_(lines), speed_(speed) {}

  /// The first that is good, of the most careful risk level that has one; else the best of all.
  ManeuverHypothesis best(const PlanningScene& scene, const LateralReplanner::Question& question,
                          const PassingDecision& passing);

  /// Of the last call, in the order in which they were looked at.
  std::vector<HypothesisOutcome> take_outcomes() { return std::move(outcomes_); }

 private:
  void find_drive(const PlanningScene& scene, const LateralReplanner::Question& question);
  void add_drive(const PlanningScene& scene, const LateralReplanner::Question& question,
                 GoalLine& on, LateralReplanner::Proposal proposal);
  void search_at_levels(const PlanningScene& scene);
  std::vector<PathQuery> first_queries(GoalLine& on, const LateralReplanner::Question& question,
                                       const PassingDecision& passing = {}) const;
  void add(const PlanningScene& scene, const std::vector<PathQuery>& queries);
  void add_others(const PlanningScene& scene, const LateralReplanner::Question& question);
  ManeuverHypothesis hypothesis_of(const PlanningScene& scene, const PathQuery& query);
  ManeuverHypothesis hypothesis_on(const PlanningScene& scene, GoalLine& on, Maneuver maneuver,
                                   LateralReplanner::Proposal proposal);
  void set_first_speed(const PlanningScene& scene, ManeuverHypothesis& hypothesis) const;
  ManeuverHypothesis& best_of_all() { return all_[best_]; }

  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  GoalLines& lines_;
  const HypothesisSpeed& speed_;
  double next_search_s_ = 0.0;
  std::optional<double> vain_since_s_;   ///< since when usual limits have not been enough
  bool drives_at_tyre_limit_ = false;    ///< what was found last is such a drive
  std::vector<ManeuverHypothesis> all_;  ///< of this cycle
  std::size_t best_ = 0;
  std::vector<HypothesisOutcome> outcomes_;
};

}  // namespace roadbed::planning::behaviour
