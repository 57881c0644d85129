#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/planning/behaviour/decision.h"
#include "roadbed/planning/behaviour/lateral_replanner.h"
#include "roadbed/planning/behaviour/maneuver_hypothesis.h"
#include "roadbed/planning/behaviour/planner_types.h"
#include "roadbed/planning/maneuvers/lane_passing.h"
#include "roadbed/planning/maneuvers/letting_in.h"
#include "roadbed/planning/maneuvers/merging.h"
#include "roadbed/planning/maneuvers/overtaking.h"
#include "roadbed/planning/maneuvers/within_lane_passing.h"
#include "roadbed/planning/obstacles/traffic.h"
#include "roadbed/planning/right_of_way/right_of_way.h"
#include "roadbed/planning/speed/lead.h"

namespace roadbed::planning::inline behaviour {

/// Who may be passed at one cycle, whose gap is merged into, and how, and who is let in.
struct PassingDecision {
  Overtaking::Decision overtaking = {};
  LanePassing::Decision in_lane = {};
  WithinLanePassing within_lane = {};
  Merging::Decision merging = {};
  LettingIn::Decision letting_in = {};
  bool is_blocked = false;  ///< by somebody who has not moved for long
};

/// The speed of a vehicle that follows its path to a place: set speed, speed controller behind
/// whoever is ahead, and braking beyond what that may ask for.
class CruiseLaw {
 public:
  explicit CruiseLaw(const PlannerSetup& setup);

  /// Where a rule of the road asks to wait, by stations of the task's line; to be asked once a
  /// cycle, before a path is taken.
  /// @param s_m    of the rear axle, on the task's line.
  /// @param sight  what is seen; none: nothing is hidden.
  std::optional<StopConstraint> look(const PlannerView& view, double s_m, const GoalLine& on,
                                     const Traffic& traffic, const Visibility* sight);

  struct Question {
    const PlannerView& view;
    const GoalLine& on;  ///< its path is the one to drive
    const Traffic& traffic;
    const PassingDecision& passing;
    Maneuver maneuver = Maneuver::keep_lane;  ///< that the path is of
    std::vector<bool> no_lead;                ///< per obstacle: it crosses the path in time
    std::optional<StopConstraint> halt;       ///< by stations of the line
    std::span<const HiddenWalker> walkers = {};

    const LateralReplanner& replanner() const { return on.replanner; }
  };
  PlannerCommand command(const Question& question);

  const DecisionOptions& options() const { return decision_options_; }

 private:
  std::optional<Lead> lead_ahead(const Question& q,
                                 const std::optional<StopConstraint>& halt) const;
  std::vector<bool> ignored_on(const PlannedPath& path, const Question& q) const;
  std::optional<StopConstraint> nearer_halt(const Question& q) const;
  std::optional<Lead> known(const Question& q, const std::optional<Lead>& ahead);
  std::optional<Lead> remembered(const PlannerView& view) const;
  SpeedAnswer answer(const Question& q, const std::optional<Lead>& lead,
                     const std::optional<StopConstraint>& halt) const;
  std::optional<double> seen_ahead_m(const Question& q) const;
  void brake_for_no_path(const Question& q, const std::optional<Lead>& lead,
                         const std::optional<StopConstraint>& halt, PlannerCommand& command);
  double pulling_out_mps(const Question& q) const;
  std::optional<double> path_left_m(const Question& q, const std::optional<Lead>& lead,
                                    const std::optional<StopConstraint>& halt) const;
  double kept_gap_m(double speed_mps) const;
  std::string lead_name(const Lead& lead) const;
  void explain(const Question& q, const SpeedAnswer& answer, PlannerCommand& command) const;
  void explain_passing(const Question& q, PlannerCommand& command) const;
  void ease(const Question& q, const Lead& lead, double stops_at_s_m,
            PlannerCommand& command) const;
  void brake_for(const Lead& lead, double speed_mps, PlannerCommand& command) const;
  void brake_for(const StopConstraint& halt, const Question& q, PlannerCommand& command) const;
  void overtake(const Question& q, PlannerCommand& command) const;

  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  DecisionOptions decision_options_;
  int blocked_cycles_ = 0;  ///< without a path, in a row
  RightOfWay right_of_way_;
  bool follows_ = false, is_beside_line_ = false;  ///< in the last cycle
  bool passes_within_lane_ = false;                ///< as the last cycle said
  struct {
    double t_s = 0.0;
    std::optional<Lead> lead;
  } last_seen_;
};

}  // namespace roadbed::planning::behaviour
