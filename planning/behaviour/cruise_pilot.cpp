#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "roadbed/planning/behaviour/decision.h"
#include "roadbed/planning/behaviour/lane_passing.h"
#include "roadbed/planning/behaviour/lead.h"
#include "roadbed/planning/behaviour/overtaking.h"
#include "roadbed/planning/behaviour/path_profile.h"
#include "roadbed/planning/behaviour/pilot.h"
#include "roadbed/planning/behaviour/right_of_way.h"
#include "roadbed/planning/behaviour/st_graph.h"
#include "roadbed/planning/behaviour/traffic.h"
#include "roadbed/planning/reference/speed_ceiling.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kSideMargin_m = 0.1;  // a lead is what the body would touch, or nearly
constexpr double kBeyondHalt_m = 1.0;
constexpr double kBeforeHalt_m = 0.4;  // of the distance before a line, that hard braking may use
constexpr double kRemembered_s = 2.0;  // a lead that is no longer measured
constexpr double kHoldingBrake_mps2 = -1.0;
constexpr double kPassOffset_m = 0.5;      // off the reference line this far is passing
constexpr double kChange_s = 3.0;          // to change lanes in, to overtake
constexpr double kPassTolerance_m = 0.25;  // more or less than asked for
constexpr double kBehindToReturn_m = 1.0, kFallsBehind_mps = 3.0;  // overtaking given up

/// Distance ahead that matters: to brake comfortably, and the gap to keep.
double look_ahead_m(double speed_mps, const DecisionOptions& options) {
  return 20.0 + options.standstill_gap_m + options.headway_s * speed_mps +
         0.5 * speed_mps * speed_mps / options.deceleration_mps2;
}

/// In the sharpest turns of real maps no body keeps to its lane; the road is wider there.
std::vector<SafetyMargins> margin_levels(double clearance_m) {
  return {{0.0, clearance_m}, {-0.3, clearance_m}, {-0.6, clearance_m}};
}

class CruisePilot : public Pilot {
 public:
  explicit CruisePilot(const PilotSetup& setup)
      : vehicle_(setup.vehicle),
        task_(setup.task),
        predicts_(setup.pilot.predicts),
        ceiling_(ceiling_of(task_.line, vehicle_, setup.driving)),
        replanner_(vehicle_, task_, task_.line,
                   {.tracking_error_m = setup.pilot.max_tracking_error_m,
                    .heading_error_rad = setup.pilot.max_heading_error_rad,
                    .margin_levels = margin_levels(setup.driving.clearance_m),
                    .keeps_candidates = setup.pilot.keeps_candidates}),
        right_of_way_(vehicle_, setup.driving, task_),
        overtaking_(vehicle_, task_, ceiling_),
        lane_passing_(vehicle_, task_, ceiling_) {
    decision_options_.deceleration_mps2 = setup.driving.comfort_deceleration_mps2;
  }

  const LateralReplanner& replanner() const override { return replanner_; }

  /// Set speed, cruise control and safety layer.
  PilotCommand decide(const PilotView& view) override {
    const double speed = view.measured.speed_mps;
    t_s_ = view.t_s;
    if (predicts_) predicted_.emplace(true_traffic(task_), view.t_s);
    replanner_.locate(view.measured);
    const ViewOnLine on_line{view.t_s, place_of(view), speed, traffic()};
    const Overtaking::Decision passing = overtaking_.look(on_line);
    const LanePassing::Decision lane =
        passing.overtaken ? LanePassing::Decision{} : lane_passing_.look(on_line);
    passes_in_lane_ = plan_path(view, passing, lane);
    const std::optional<StopConstraint> halt = nearer(halt_ahead(view), lane);
    const std::optional<Lead> truth = lead_ahead(view, halt);
    std::optional<Lead> lead = view.speed_controller.observe(view.measured, truth, view.t_s);
    if (lead || !truth) {
      last_seen_ = {view.t_s, lead};
    } else {
      lead = remembered(view);
    }
    SpeedAnswer answer = choose_speed(question(view.measured, lead, halt), decision_options_);
    if (lane.most_mps && *lane.most_mps < answer.set.speed_mps) {
      answer.set = {.speed_mps = *lane.most_mps, .acceleration_mps2 = 0.0};
    }
    PilotCommand command;
    command.acceleration_mps2 = view.speed_controller.acceleration_mps2(view.measured, answer.set);
    command.saturated = std::abs(command.acceleration_mps2) >= kMostCommand_mps2;
    if (answer.hold) {
      command.acceleration_mps2 = std::min(command.acceleration_mps2, kHoldingBrake_mps2);
    }
    command.set_speed_mps = set_speed_mps_ = answer.set.speed_mps;
    if (truth) {
      command.lead = {task_.obstacles[truth->obstacle].id, truth->gap_m, truth->speed_mps};
    }
    explain(answer, lead, speed, command);
    if (halt && halt->is_hard) brake_for(*halt, speed, command);
    if (passing.overtaken) overtake(passing, speed, command);
    if (passes_in_lane_ &&
        (command.behaviour == Behaviour::cruise || command.behaviour == Behaviour::pass)) {
      command.behaviour = Behaviour::pass;
      command.reason = lane.reason;
    }
    std::string why_not = lane.reason.empty() ? passing.reason : lane.reason;
    if (lane.passed && !passes_in_lane_) {
      why_not = fmt::format("{} is not passed: no path leads to the next lane",
                            task_.obstacles[*lane.passed].id);
    }
    if (!passing.overtaken && !why_not.empty() && command.behaviour == Behaviour::follow) {
      command.reason += "; " + why_not;
    }
    view.speed_controller.sent(command.acceleration_mps2);
    return command;
  }

 private:
  geometry::LinePosition place_of(const PilotView& view) const {
    return task_.line.project(view.measured.map_from_vehicle.position(), replanner_.s_m());
  }

  /// Where somebody is overtaken the lateral planner is told where; elsewhere it is kept off the
  /// lane of oncoming traffic while somebody drives ahead.
  /// @return whether the path leads to the next lane.
  bool plan_path(const PilotView& view, const Overtaking::Decision& passing,
                 const LanePassing::Decision& lane) {
    const double speed = view.measured.speed_mps;
    const std::vector<Obstacle> ahead = obstacles_to_plan_for(view);
    LateralReplanner::Question question{
        .t_s = view.t_s,
        .measured = view.measured,
        .speed = {.speed_mps = speed,
                  .acceleration_mps2 = view.measured.acceleration_mps2,
                  .target_mps = set_speed_mps_},
        .obstacles = ahead};
    const bool stays_beside =
        passing.overtaken && (!passing.falls_back || passing.gap_m < kBehindToReturn_m);
    if (stays_beside && takes_path_at(*passing.pass_at_m, question)) return false;
    if (lane.offset_m) {
      LateralReplanner::Question at_free_speed = question;
      at_free_speed.speed.target_mps = ceiling_.at(replanner_.s_m()).speed_mps;
      if (takes_path_at(*lane.offset_m, at_free_speed)) return true;
    }
    LateralReplanner::Offsets offsets;
    keep_within(passing.keep_within_m, passing.side, offsets);
    keep_within(lane.keep_within_m, lane.side, offsets);
    replanner_.take(replanner_.propose(question, offsets));
    return false;
  }

  static void keep_within(const std::optional<double>& offset_m, double side,
                          LateralReplanner::Offsets& offsets) {
    if (!offset_m) return;
    if (side > 0.0) {
      offsets.most_m = std::min(offsets.most_m, *offset_m);
    } else {
      offsets.least_m = std::max(offsets.least_m, -*offset_m);
    }
  }

  /// A change to an offset takes a while, at any speed; false: nothing leads there.
  bool takes_path_at(double offset_m, LateralReplanner::Question question) {
    const double speed = question.speed.speed_mps;
    question.ends.least_m = std::max(question.ends.least_m, kChange_s * speed);
    question.ends.most_m = std::max(question.ends.most_m, (kChange_s + 1.0) * speed);
    question.checks_completion = false;
    const LateralReplanner::Proposal proposal =
        replanner_.propose(question, {offset_m - kPassTolerance_m, offset_m + kPassTolerance_m});
    if (proposal.plan.chosen) replanner_.take(proposal);
    return proposal.plan.chosen.has_value();
  }

  void overtake(const Overtaking::Decision& passing, double speed_mps,
                PilotCommand& command) const {
    if (command.behaviour == Behaviour::emergency) return;
    command.behaviour = Behaviour::pass;
    command.reason = passing.reason;
    if (!passing.falls_back) return;
    const double lead_mps = traffic().obstacles[*passing.overtaken].motion.at(t_s_).speed_mps;
    const bool falls_behind = speed_mps < lead_mps - kFallsBehind_mps;
    command.acceleration_mps2 =
        std::min(command.acceleration_mps2, falls_behind ? 0.0 : -kMostCommand_mps2);
  }
  /// Who follows keeps its own distance: no path is given up for it.
  std::vector<Obstacle> obstacles_to_plan_for(const PilotView& view) const {
    std::vector<Obstacle> ahead = predicted_ ? predicted_->obstacles() : task_.obstacles;
    const geometry::LinePosition at = place_of(view);
    const VehicleOnLine vehicle{task_.line, at.s_m, at.d_m, vehicle_.width_m};
    std::erase_if(ahead, [&](const Obstacle& obstacle) {
      return !obstacle.is_static() && is_following(obstacle, view.t_s, vehicle);
    });
    return ahead;
  }

  /// The end of the lane that somebody is passed in is not to be passed either.
  std::optional<StopConstraint> nearer(std::optional<StopConstraint> halt,
                                       const LanePassing::Decision& lane) const {
    constexpr double kBeforeEnd_m = 25.0;  // to come back in
    if (!passes_in_lane_) return halt;
    const double end_s_m = lane.lane_end_s_m - vehicle_.front_m() - kBeforeEnd_m;
    if (halt && halt->s_m < end_s_m) return halt;
    return StopConstraint{.s_m = end_s_m, .reason = "the passing lane ends"};
  }

  std::optional<StopConstraint> halt_ahead(const PilotView& view) {
    const PlannedPath path = replanner_.expected_path();
    return right_of_way_.look({.t_s = view.t_s,
                               .s_m = replanner_.s_m(),
                               .speed_mps = view.measured.speed_mps,
                               .path = path,
                               .ceiling = ceiling_,
                               .traffic = traffic(),
                               .acceleration_mps2 = view.measured.acceleration_mps2});
  }

  /// Who crosses, and who drives on the path now but will have left it, or the path its lane, when
  /// the vehicle comes there at the speed of the free road.
  std::vector<bool> ignored_on(const PlannedPath& path, const PilotView& view) const {
    std::vector<bool> ignored = right_of_way_.crossing();
    if (!passes_in_lane_) return ignored;
    constexpr double kAhead_m = 80.0, kMargin_m = 0.3;
    constexpr std::size_t kSteps = 60;
    const PathProfile profile =
        sample_path_profile(path, replanner_.s_m(), kAhead_m, ceiling_, vehicle_);
    std::vector<double> ahead = drive_on(profile, view.measured.speed_mps, kAhead_m);
    ahead.resize(std::min(ahead.size(), kSteps));
    const int last = static_cast<int>(ahead.size()) - 1;
    const StGraph occupancy(profile, traffic(), view.t_s, last, kMargin_m);
    std::vector<bool> met(ignored.size(), false);
    for (int k = 0; k <= last; ++k) {
      const double ahead_m = ahead[static_cast<std::size_t>(k)];
      // In the end the gap that is kept counts, too: who is as fast is never reached.
      const double kept_m = k < last ? 0.0 : kept_gap_m(view.measured.speed_mps);
      for (const StInterval& part : occupancy.at(k)) {
        if (ahead_m + kept_m >= part.from_m && ahead_m <= part.to_m) met[part.obstacle] = true;
      }
    }
    for (std::size_t i = 0; i < ignored.size(); ++i) {
      ignored[i] = ignored[i] || (!task_.obstacles[i].is_static() && !met[i]);
    }
    return ignored;
  }

  double kept_gap_m(double speed_mps) const {
    return decision_options_.standstill_gap_m + decision_options_.headway_s * speed_mps;
  }

  /// Who is beyond the place to halt at is none.
  std::optional<Lead> lead_ahead(const PilotView& view,
                                 const std::optional<StopConstraint>& halt) const {
    const double speed = view.measured.speed_mps;
    const double to_goal_m = task_.line.goal_s_m() - replanner_.s_m();
    const double look_m = std::min(look_ahead_m(speed, decision_options_),
                                   std::max(0.0, to_goal_m) + vehicle_.front_m());
    const PlannedPath path = passes_in_lane_ ? replanner_.path() : replanner_.expected_path();
    std::optional<Lead> lead = find_lead(path, replanner_.s_m(), look_m, task_.obstacles, view.t_s,
                                         vehicle_, kSideMargin_m, ignored_on(path, view));
    if (lead && halt && lead->gap_m > halt->s_m - replanner_.s_m() + kBeyondHalt_m) lead.reset();
    return lead;
  }

  /// A lead that is not measured is taken to drive on at its speed, for a while.
  std::optional<Lead> remembered(const PilotView& view) const {
    const double since_s = view.t_s - last_seen_.t_s;
    if (!last_seen_.lead || since_s > kRemembered_s) return std::nullopt;
    Lead lead = *last_seen_.lead;
    const double closing = view.measured.speed_mps - lead.speed_mps;
    lead.gap_m = std::max(0.0, lead.gap_m - closing * since_s);
    return lead;
  }

  Traffic traffic() const { return predicted_ ? predicted_->traffic() : true_traffic(task_); }

  SpeedQuestion question(const VehicleState& measured, const std::optional<Lead>& lead,
                         const std::optional<StopConstraint>& halt) const {
    return {.ceiling = ceiling_,
            .s_m = replanner_.s_m(),
            .goal_s_m = task_.line.goal_s_m(),
            .speed_mps = measured.speed_mps,
            .acceleration_mps2 = measured.acceleration_mps2,
            .lead = lead,
            .lead_name = lead ? lead_name(*lead) : "",
            .path_left_m = path_left_m(lead),
            .halt = halt};
  }

  /// How far the kept path goes when nothing is feasible. A lead on it bounds the speed by itself.
  std::optional<double> path_left_m(const std::optional<Lead>& lead) const {
    if (replanner_.last_plan().chosen) return std::nullopt;
    if (replanner_.something_is_in_the_way() && !lead) return 0.0;
    return replanner_.checked_ahead_m();
  }

  /// The cruise control cannot ask for what this halt takes.
  void brake_for(const StopConstraint& halt, double speed_mps, PilotCommand& command) const {
    const auto braking =
        emergency_stop_mps2(speed_mps, halt.s_m + kBeforeHalt_m - replanner_.s_m());
    if (!braking || -*braking > command.acceleration_mps2) return;
    command.acceleration_mps2 = -*braking;
    command.behaviour = Behaviour::emergency;
    command.reason = fmt::format("braking at {:.1f} m/s²: {}", *braking, halt.reason);
  }

  std::string lead_name(const Lead& lead) const {
    const Obstacle& obstacle = task_.obstacles[lead.obstacle];
    return fmt::format("{} {}", obstacle.kind, obstacle.id);
  }

  void explain(const SpeedAnswer& answer, const std::optional<Lead>& lead, double speed_mps,
               PilotCommand& command) const {
    command.behaviour = answer.behaviour;
    command.reason = answer.reason;
    const double offset_m = replanner_.path().lateral_at(replanner_.s_m()).d_m;
    const auto& chosen = replanner_.last_plan().chosen;
    const double end_m = chosen ? chosen->end_d_m : offset_m;
    if (answer.behaviour == Behaviour::cruise &&
        std::max(std::abs(offset_m), std::abs(end_m)) > kPassOffset_m) {
      command.behaviour = Behaviour::pass;
      command.reason = fmt::format("the way is free {:.1f} m {} of the reference line",
                                   std::abs(end_m), end_m < 0.0 ? "right" : "left");
    }
    if (!lead) return;
    if (const auto braking = emergency_deceleration_mps2(speed_mps, *lead)) {
      command.acceleration_mps2 = std::min(command.acceleration_mps2, -*braking);
      command.behaviour = Behaviour::emergency;
      command.reason =
          fmt::format("braking at {:.1f} m/s²: {} is {:.1f} m ahead, closing at {:.1f} m/s",
                      *braking, lead_name(*lead), lead->gap_m, speed_mps - lead->speed_mps);
    }
  }

  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  bool predicts_;
  std::optional<PredictedTraffic> predicted_;  ///< none: the true future is known
  DecisionOptions decision_options_;
  SpeedCeiling ceiling_;
  LateralReplanner replanner_;
  RightOfWay right_of_way_;
  Overtaking overtaking_;
  LanePassing lane_passing_;
  bool passes_in_lane_ = false;
  struct {
    double t_s = 0.0;
    std::optional<Lead> lead;
  } last_seen_;
  double set_speed_mps_ = 0.0;
  double t_s_ = 0.0;  ///< of the cycle
};

}  // namespace

std::unique_ptr<Pilot> make_cruise_pilot(const PilotSetup& setup) {
  return std::make_unique<CruisePilot>(setup);
}

}  // namespace roadbed::planning::behaviour
