#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/planning/lateral/knotted_offset.h"
#include "roadbed/planning/lateral/plan_types.h"
#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/planning/plan.h"
#include "roadbed/planning/task/driving_task.h"

namespace roadbed::planning::inline behaviour {

/// The question of a cycle, and what became of every candidate.
struct ExplainedPlan {
  /// The line and the obstacles are copied, as the planner's may be gone before; occupied space is
  /// kept by reference.
  /// @param on_line, end_m  that it was planned on: past the end it goes on straight.
  ExplainedPlan(const ReferenceLine& on_line, double end_m, const PlanInput& asked, Plan answer);
  ExplainedPlan(const ExplainedPlan&) = delete;
  ExplainedPlan& operator=(const ExplainedPlan&) = delete;

  ReferenceLine line;
  std::vector<Obstacle> obstacles;
  PlanInput input;  ///< but for the last plan
  Plan plan;        ///< with its candidates
};

/// Margins that are tried in turn on the way to a place: in the sharpest turns of real maps no body
/// keeps to its lane; the road is wider there.
inline std::vector<SafetyMargins> margin_levels_on_route(double clearance_m) {
  return {{0.0, clearance_m}, {-0.3, clearance_m}, {-0.6, clearance_m}};
}

/// The path that is being driven, from cycle to cycle: plans on from the last plan while the
/// vehicle follows it well enough, and keeps the last path when nothing is feasible.
class LateralReplanner {
 public:
  struct Bounds {
    double tracking_error_m;
    double heading_error_rad;
    /// What is tried in turn until something is feasible.
    std::vector<SafetyMargins> margin_levels;
    /// Whether an obstacle in the way is a reason to relax the margins, and to try at a braking
    /// speed, or to wait.
    bool squeezes_past = false;
    bool keeps_candidates = false;  ///< those of what is taken, see candidates()
    CostTerms weights = default_weights();
  };

  /// @param line  to drive along, of the world.
  LateralReplanner(const geometry::VehicleShape& vehicle, const DrivingTask& task,
                   const ReferenceLine& line, const Bounds& bounds);

  /// How far ahead candidates may end.
  struct Ends {
    double least_m = PlanOptions{}.min_l_m, most_m = PlanOptions{}.max_l_m;
  };

  /// What is planned from and against.
  struct Question {
    double t_s;
    const VehicleState& measured;
    SpeedPlan speed;  ///< the longitudinal plan so far
    Ends ends = {};
    const std::vector<Obstacle>& obstacles;
    bool checks_completion =
        true;  ///< a maneuver among moving traffic has to be completable (maneuver_completion.h)
    bool explains = false;  ///< what is taken is explained, see explained()
  };

  /// End offsets that candidates may have.
  struct Offsets {
    double least_m = PlanOptions{}.min_d_m, most_m = PlanOptions{}.max_d_m;
  };

  /// A plan to look at before it is taken.
  struct Proposal {
    Plan plan;
    double beyond_the_edge_m = 0.0;
    double checked_m = 0.0;  ///< from the start on; of a path that is kept: that it may be driven
    /// What found it, and how, if candidates are kept or explained; valid as long as the question
    /// is.
    std::shared_ptr<PlanningCycle> cycle = nullptr;
    bool explains = false;
    SafetyMargins margins = {};
    EndOffsetRange ends = {};
    /// Of a path through several knots, in place of the plan's quintic.
    std::shared_ptr<const KnottedOffset> knots = nullptr;
  };

  /// Where the vehicle is: the start of what is proposed until the next call.
  void locate(const VehicleState& measured) {
    start_ = start_state(measured);
    speed_mps_ = measured.speed_mps;
    cycles_.reset();
  }

  /// Drives on along this line, from the path that was driven along another one.
  /// @pre both are located, `before` at this cycle
  void take_over(const LateralReplanner& before);

  /// Until the next call of locate() every question but its offsets is the same one.
  /// The cheapest candidate at the first fallback level that has a feasible one, else what was
  /// found at the last.
  /// @param may_leave_lanes  margins with which the body sticks out of the corridor are tried too;
  ///                         if not, it is one of several tries, on a coarser grid.
  Proposal propose(const Question& question, const Offsets& offsets,
                   bool may_leave_lanes = true) const;
  /// The path of a drive that was found otherwise, led on beside the line past its end; none where
  /// the drive does not go along the line.
  /// @param drive  states of the rear axle every 0.1 s, from the vehicle's own at `start_s` on.
  std::optional<Proposal> through(std::span<const VehicleState> drive, double start_s) const;
  /// How far the kept path can be driven from here with the front inside these offsets, or no
  /// farther outside than it is [m]; infinite if it stays there as far as it was found feasible.
  double kept_within_m(const Offsets& offsets) const;
  /// What was taken last, if that is such a path, and the vehicle is on it; it can be taken again.
  /// Its trajectory goes on from now at the speed of now.
  std::optional<Proposal> kept_drive(double now_s, double speed_mps) const;
  /// The candidates that were looked at instead, to explain such a path by if that is asked for.
  void explain_by_candidates(const Question& question, Proposal& drive) const;
  void take(const Proposal& proposal);
  /// The path of a proposal; without a candidate the one that is kept.
  PlannedPath path_of(const Proposal& proposal) const;
  /// The same, led back to the reference line beyond the plan's end: where the vehicle is expected
  /// to drive later on.
  PlannedPath expected_path_of(const Proposal& proposal) const;

  /// Of the last cycle; `chosen` is empty if nothing was feasible.
  const Plan& last_plan() const { return plan_; }
  /// What became of the candidates of the last cycle, if they are kept.
  const std::optional<CandidateGrid>& candidates() const { return candidates_; }
  /// Of the last cycle, if its question asked for it.
  const std::shared_ptr<const ExplainedPlan>& explained() const { return explained_; }
  bool from_measurement() const { return from_measurement_; }

  /// How far the body was allowed past the corridor's edge, because nothing keeps to it [m].
  double beyond_the_edge_m() const { return beyond_the_edge_m_; }

  /// Station of the measured rear axle at the last cycle.
  double s_m() const { return s_m_; }

  /// How far the kept path was found feasible when it was planned, from the vehicle on, and may be
  /// driven now.
  double checked_ahead_m() const { return std::min(checked_to_s_m_, kept_to_s_m_) - s_m_; }

  /// Whether the last cycle rejected candidates because they would touch something.
  bool something_is_in_the_way() const;

  /// The path to drive.
  const PlannedPath& path() const { return *path_; }

  /// As expected_path_of(), of what was taken.
  PlannedPath expected_path() const { return led_back(kept_path(), path_end_s_m_); }

 private:
  /// One of the attempts to find a feasible candidate, from what is asked for on to less and less.
  struct FallbackLevel {
    SafetyMargins margins;
    double l_step_m;
    bool brakes;  ///< instead of the planned speed
  };
  struct Cycles;

  std::shared_ptr<const ExplainedPlan> explain(const Proposal& proposal) const;
  LateralState start_state(const VehicleState& measured);
  std::vector<FallbackLevel> fallback_levels(const Question& question, bool may_leave_lanes) const;
  std::shared_ptr<Cycles> cycles_for(const Question& question) const;
  bool shares_cycles() const { return bounds_.squeezes_past; }
  PlanInput input_for(const Question& question) const;
  PlanOptions options_for(const Question& question, const Offsets& offsets, double l_step_m) const;
  double held_until_m(const Plan& plan) const;
  PlannedPath kept_path() const;
  PlannedPath led_back(const PlannedPath& path, double end_s_m) const;

  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  const ReferenceLine& reference_;
  Bounds bounds_;
  double line_end_m_;  ///< past it the line is seen to go on straight
  LineView line_;
  LateralState start_;
  Plan plan_;
  std::optional<CandidateGrid> candidates_;
  std::shared_ptr<const ExplainedPlan> explained_;
  std::optional<PlannedPath> path_;
  std::optional<Proposal> drive_;  ///< that path_ is the path of, if it has knots
  double path_end_s_m_ = 0.0;
  double checked_to_s_m_ = 0.0;
  double kept_to_s_m_ = std::numeric_limits<double>::infinity();  // in this cycle
  double s_m_ = 0.0, speed_mps_ = 0.0;
  double beyond_the_edge_m_ = 0.0;
  bool from_measurement_ = false;
  mutable std::shared_ptr<Cycles> cycles_;  ///< what was evaluated since locate()
};

}  // namespace roadbed::planning::behaviour
