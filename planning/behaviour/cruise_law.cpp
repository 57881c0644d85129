#include "roadbed/planning/behaviour/cruise_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/planning/speed/path_profile.h"
#include "roadbed/planning/speed/st_graph.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kSideMargin_m = 0.1;  // a lead is what the body would touch, or nearly
constexpr double kBeyondHalt_m = 1.0;
constexpr double kBeforeHalt_m = 0.4;  // of the distance before a line, that hard braking may use
constexpr double kBeforeStanding_m = 5.0;  // of what comes into sight
constexpr int kBlockedCycles = 4;          // in a row, until it is no passing matter
constexpr double kCreeps_mps = 4.0;        // slower it stops comfortably anyway
constexpr double kRemembered_s = 2.0;      // a lead that is no longer measured
constexpr double kHoldingBrake_mps2 = -1.0;
constexpr double kBesideLine_m = 0.5;     // off the reference line this far is passing
constexpr double kEasedRoom_m = 1.0;      // less than what merging takes
constexpr double kFallsBehind_mps = 3.0;  // slower than who was to be overtaken

/// Distance ahead that matters: to brake comfortably, and the gap to keep.
double look_ahead_m(double speed_mps, const DecisionOptions& options) {
  return 20.0 + options.standstill_gap_m + options.headway_s * speed_mps +
         0.5 * speed_mps * speed_mps / options.deceleration_mps2;
}

}  // namespace

CruiseLaw::CruiseLaw(const PlannerSetup& setup)
    : vehicle_(setup.vehicle),
      task_(setup.task),
      right_of_way_(setup.vehicle, setup.driving, setup.task) {
  decision_options_.acceleration_mps2 = setup.driving.comfort_acceleration_mps2;
  decision_options_.deceleration_mps2 = setup.driving.comfort_deceleration_mps2;
  decision_options_.headway_s = setup.driving.headway_s;
  decision_options_.standstill_gap_m = setup.driving.standstill_gap_m;
}

std::optional<StopConstraint> CruiseLaw::look(const PlannerView& view, double s_m,
                                              const GoalLine& on, const Traffic& traffic,
                                              const Visibility* sight) {
  const PlannedPath path = on.replanner.expected_path();
  return right_of_way_.look({.t_s = view.t_s,
                             .s_m = s_m,
                             .speed_mps = view.measured.speed_mps,
                             .path = path,
                             .path_s_m = on.replanner.s_m(),
                             .ceiling = on.ceiling,
                             .traffic = traffic,
                             .acceleration_mps2 = view.measured.acceleration_mps2,
                             .sight = sight});
}

PlannerCommand CruiseLaw::command(const Question& q) {
  const PlannerView& view = q.view;
  const double speed = view.measured.speed_mps;
  const std::optional<StopConstraint> halt = nearer_halt(q);
  const std::optional<Lead> ahead = lead_ahead(q, halt);
  const std::optional<Lead> lead = known(q, ahead);
  const SpeedAnswer chosen = answer(q, lead, halt);
  PlannerCommand command;
  command.acceleration_mps2 = view.speed_controller.acceleration_mps2(view.measured, chosen.set);
  command.saturated = std::abs(command.acceleration_mps2) >= kMostCommand_mps2;
  if (chosen.hold) {
    command.acceleration_mps2 = std::min(command.acceleration_mps2, kHoldingBrake_mps2);
  }
  command.set_speed_mps = chosen.set.speed_mps;
  if (ahead) {
    command.lead = {task_.obstacles[ahead->obstacle].id, ahead->gap_m, ahead->speed_mps};
  }
  if (halt) command.halt_m = halt->s_m - q.replanner().s_m();
  follows_ = chosen.behaviour == Behaviour::follow;
  explain(q, chosen, command);
  is_beside_line_ = command.behaviour == Behaviour::pass;
  const double stops_at_s_m = std::min(q.on.line.goal_s_m(), halt ? halt->s_m : 1e9);
  if (lead) ease(q, *lead, stops_at_s_m, command);
  if (lead) brake_for(*lead, speed, command);
  if (halt) brake_for(*halt, q, command);
  brake_for_no_path(q, lead, halt, command);
  if (q.passing.overtaking.overtaken) overtake(q, command);
  explain_passing(q, command);
  passes_within_lane_ =
      q.maneuver == Maneuver::pass_within_lane && command.behaviour == Behaviour::pass;
  return command;
}

/// The end of the lane that somebody is passed in is not to be passed either, nor where to wait for
/// who is oncoming.
std::optional<StopConstraint> CruiseLaw::nearer_halt(const Question& q) const {
  constexpr double kBeforeEnd_m = 25.0;  // to come back in
  if (const auto& waits_at_s_m = q.passing.overtaking.waits_at_s_m) {
    if (q.halt && q.halt->s_m < *waits_at_s_m) return q.halt;
    return StopConstraint{.s_m = *waits_at_s_m, .reason = q.passing.overtaking.reason};
  }
  if (q.maneuver != Maneuver::pass_in_lane) return q.halt;
  const double end_s_m = q.passing.in_lane.lane_end_s_m - vehicle_.front_m() - kBeforeEnd_m;
  if (q.halt && q.halt->s_m < end_s_m) return q.halt;
  return StopConstraint{.s_m = end_s_m, .reason = "the passing lane ends"};
}

/// Who crosses, and who drives on the path now but will have left it, or the path its lane, when
/// the vehicle comes there at the speed of the free road.
std::vector<bool> CruiseLaw::ignored_on(const PlannedPath& path, const Question& q) const {
  std::vector<bool> ignored = right_of_way_.crossing();
  for (std::size_t i = 0; i < q.no_lead.size(); ++i) ignored[i] = ignored[i] || q.no_lead[i];
  if (q.maneuver != Maneuver::pass_in_lane) return ignored;
  constexpr double kAhead_m = 80.0, kMargin_m = 0.3;
  constexpr std::size_t kSteps = 60;
  const double speed = q.view.measured.speed_mps;
  const PathProfile profile =
      sample_path_profile(path, q.replanner().s_m(), kAhead_m, q.on.ceiling, vehicle_);
  std::vector<double> ahead = drive_on(profile, speed, kAhead_m);
  ahead.resize(std::min(ahead.size(), kSteps));
  const int last = static_cast<int>(ahead.size()) - 1;
  const StGraph occupancy(profile, q.traffic, q.view.t_s, last, kMargin_m);
  std::vector<bool> met(ignored.size(), false);
  for (int k = 0; k <= last; ++k) {
    const double ahead_m = ahead[static_cast<std::size_t>(k)];
    // In the end the gap that is kept counts, too: who is as fast is never reached.
    const double kept_m = k < last ? 0.0 : kept_gap_m(speed);
    for (const StInterval& part : occupancy.at(k)) {
      if (ahead_m + kept_m >= part.from_m && ahead_m <= part.to_m) met[part.obstacle] = true;
    }
  }
  for (std::size_t i = 0; i < ignored.size(); ++i) {
    ignored[i] = ignored[i] || (!task_.obstacles[i].is_static() && !met[i]);
  }
  return ignored;
}

double CruiseLaw::kept_gap_m(double speed_mps) const {
  return decision_options_.standstill_gap_m + decision_options_.headway_s * speed_mps;
}

/// Who is beyond the place to halt at is none.
std::optional<Lead> CruiseLaw::lead_ahead(const Question& q,
                                          const std::optional<StopConstraint>& halt) const {
  const LateralReplanner& replanner = q.replanner();
  const double to_goal_m = q.on.line.goal_s_m() - replanner.s_m();
  const double look_m = std::min(look_ahead_m(q.view.measured.speed_mps, decision_options_),
                                 std::max(0.0, to_goal_m) + vehicle_.front_m());
  const bool stays_beside =
      q.maneuver == Maneuver::pass_in_lane || q.maneuver == Maneuver::pass_within_lane;
  const PlannedPath path = stays_beside ? replanner.path() : replanner.expected_path();
  std::optional<Lead> lead = find_lead(path, replanner.s_m(), look_m, q.traffic.obstacles,
                                       q.view.t_s, vehicle_, kSideMargin_m, ignored_on(path, q));
  if (lead && halt && lead->gap_m > halt->s_m - replanner.s_m() + kBeyondHalt_m) lead.reset();
  return lead;
}

std::optional<Lead> CruiseLaw::known(const Question& q, const std::optional<Lead>& ahead) {
  std::optional<Lead> lead = q.view.speed_controller.observe(q.view.measured, ahead, q.view.t_s);
  if (!lead && ahead) return remembered(q.view);
  last_seen_ = {q.view.t_s, lead};
  return lead;
}

/// A lead that is not measured is taken to drive on at its speed, for a while.
std::optional<Lead> CruiseLaw::remembered(const PlannerView& view) const {
  const double since_s = view.t_s - last_seen_.t_s;
  if (!last_seen_.lead || since_s > kRemembered_s) return std::nullopt;
  Lead lead = *last_seen_.lead;
  const double closing = view.measured.speed_mps - lead.speed_mps;
  lead.gap_m = std::max(0.0, lead.gap_m - closing * since_s);
  return lead;
}

/// What is left of the sight when the reaction's way is driven.
std::optional<double> CruiseLaw::seen_ahead_m(const Question& q) const {
  if (!task_.sight_m) return std::nullopt;
  const double reacting_m = q.view.measured.speed_mps * kActuatorLag_s;
  return std::max(0.0, *task_.sight_m - vehicle_.front_m() - kBeforeStanding_m - reacting_m);
}

SpeedAnswer CruiseLaw::answer(const Question& q, const std::optional<Lead>& lead,
                              const std::optional<StopConstraint>& halt) const {
  SpeedAnswer answer = choose_speed({.ceiling = q.on.ceiling,
                                     .s_m = q.replanner().s_m(),
                                     .goal_s_m = q.on.line.goal_s_m(),
                                     .speed_mps = q.view.measured.speed_mps,
                                     .acceleration_mps2 = q.view.measured.acceleration_mps2,
                                     .lead = lead,
                                     .lead_name = lead ? lead_name(*lead) : "",
                                     .let_in = q.passing.letting_in.behind,
                                     .let_in_reason = q.passing.letting_in.reason,
                                     .follows = follows_,
                                     .path_left_m = path_left_m(q, lead, halt),
                                     .halt = halt,
                                     .seen_ahead_m = seen_ahead_m(q),
                                     .walkers = q.walkers,
                                     .creep_mps = right_of_way_.creep_mps()},
                                    decision_options_);
  answer.set.speed_mps = std::min(answer.set.speed_mps, pulling_out_mps(q));
  const std::optional<double>& most_mps = q.passing.in_lane.most_mps;
  if (most_mps && *most_mps < answer.set.speed_mps) {
    answer.set = {.speed_mps = *most_mps, .acceleration_mps2 = 0.0};
  }
  const Merging::Decision& merging = q.passing.merging;
  const bool slows = merging.most_mps && *merging.most_mps < answer.set.speed_mps;
  if (slows) answer.set = {.speed_mps = *merging.most_mps, .acceleration_mps2 = 0.0};
  if (!merging.reason.empty() && (slows || answer.behaviour == Behaviour::cruise)) {
    answer.behaviour = Behaviour::yield;
    answer.reason = merging.reason;
  }
  return answer;
}

/// The path round somebody who blocks the road may bend as sharply as the wheels can be turned near
/// rest, and is driven as slowly.
double CruiseLaw::pulling_out_mps(const Question& q) const {
  constexpr double kSlow_mps = 5.0, kLook_m = 4.0, kLook_s = 1.0, kLeast_mps = 0.5;
  constexpr BendLimits kWithRoomToSteer{.max_lateral_acceleration_mps2 = 2.0,
                                        .steering_rate_fraction = 0.4};
  const double speed_mps = q.view.measured.speed_mps;
  if (!q.passing.is_blocked || speed_mps > kSlow_mps)
    return std::numeric_limits<double>::infinity();
  const PathProfile ahead =
      sample_path_profile(q.replanner().expected_path(), q.replanner().s_m(),
                          kLook_m + kLook_s * speed_mps, q.on.ceiling, vehicle_, kWithRoomToSteer);
  return std::max(kLeast_mps, *std::ranges::min_element(ahead.most_mps));
}

/// How far the kept path goes when nothing is feasible. A lead on it bounds the speed by itself, or
/// the halt before him.
std::optional<double> CruiseLaw::path_left_m(const Question& q, const std::optional<Lead>& lead,
                                             const std::optional<StopConstraint>& halt) const {
  if (q.replanner().last_plan().chosen) return std::nullopt;
  if (!q.replanner().something_is_in_the_way() || lead) return q.replanner().checked_ahead_m();
  const bool halts_first = halt && lead_ahead(q, std::nullopt);
  return halts_first ? std::max(0.0, halt->s_m - q.replanner().s_m()) : 0.0;
}

std::string CruiseLaw::lead_name(const Lead& lead) const {
  const Obstacle& obstacle = task_.obstacles[lead.obstacle];
  return fmt::format("{} {}", obstacle.kind, obstacle.id);
}

void CruiseLaw::explain(const Question& q, const SpeedAnswer& answer,
                        PlannerCommand& command) const {
  command.behaviour = answer.behaviour;
  command.reason = answer.reason;
  const double offset_m = q.replanner().path().lateral_at(q.replanner().s_m()).d_m;
  const auto& chosen = q.replanner().last_plan().chosen;
  const double end_m = chosen ? chosen->end_d_m : offset_m;
  if (answer.behaviour == Behaviour::cruise &&
      q.passing.merging.along == Merging::Along::route_line &&
      std::max(std::abs(offset_m), std::abs(end_m)) >
          (is_beside_line_ ? 0.5 : 1.0) * kBesideLine_m) {
    command.behaviour = Behaviour::pass;
    command.reason = fmt::format("the way is free {:.1f} m {} of the reference line",
                                 std::abs(end_m), end_m < 0.0 ? "right" : "left");
  }
}

void CruiseLaw::explain_passing(const Question& q, PlannerCommand& command) const {
  const LanePassing::Decision& lane = q.passing.in_lane;
  const Overtaking::Decision& overtaking = q.passing.overtaking;
  if (q.maneuver == Maneuver::pass_in_lane &&
      (command.behaviour == Behaviour::cruise || command.behaviour == Behaviour::pass)) {
    command.behaviour = Behaviour::pass;
    command.reason = lane.reason;
  }
  if (q.maneuver == Maneuver::pass_within_lane && command.behaviour == Behaviour::cruise) {
    command.behaviour = Behaviour::pass;
  }
  if (q.maneuver == Maneuver::pass_within_lane && command.behaviour == Behaviour::pass) {
    command.reason =
        fmt::format("passes {} within the lane", task_.obstacles[*q.passing.within_lane.passed].id);
  }
  // Begun once, it goes on while the body at the end of the path still comes near.
  if (q.maneuver == Maneuver::pass_within_lane && command.behaviour == Behaviour::follow &&
      passes_within_lane_ && command.lead &&
      command.lead->id == task_.obstacles[*q.passing.within_lane.passed].id) {
    command.behaviour = Behaviour::pass;
    command.reason = fmt::format("passes {} within the lane; {}", command.lead->id, command.reason);
  }
  std::string why_not = lane.reason.empty() ? overtaking.reason : lane.reason;
  if (why_not.empty()) why_not = q.passing.within_lane.reason;
  if (why_not.empty() && q.passing.within_lane.passed && q.maneuver != Maneuver::pass_within_lane) {
    why_not = fmt::format("{} is not passed: no path in the lane is clear of where it may go",
                          task_.obstacles[*q.passing.within_lane.passed].id);
  }
  if (lane.passed && q.maneuver != Maneuver::pass_in_lane) {
    why_not = fmt::format("{} is not passed: no path leads to the next lane",
                          task_.obstacles[*lane.passed].id);
  }
  if (!overtaking.overtaken && !why_not.empty() && command.behaviour == Behaviour::follow) {
    command.reason += "; " + why_not;
  }
}

/// In a gap that is safe, though shorter than what is kept, the gap to keep may open slowly, so
/// that nobody behind has to brake for it.
void CruiseLaw::ease(const Question& q, const Lead& lead, double stops_at_s_m,
                     PlannerCommand& command) const {
  constexpr double kBrakesHard_mps2 = -0.5, kOpens_mps = 0.5, kStandingLead_mps = 1.0;
  constexpr double kEased_mps2 = 0.4, kLeastLeft_m = 0.5, kNotYetKept_m = 5.0;
  const double speed_mps = q.view.measured.speed_mps;
  const bool opens = lead.speed_mps > speed_mps + kOpens_mps;
  if (q.passing.merging.merged_behind != lead.obstacle || command.behaviour != Behaviour::follow) {
    return;
  }
  const double stopping_m = 0.5 * speed_mps * speed_mps / decision_options_.deceleration_mps2;
  const bool stops = stops_at_s_m - q.replanner().s_m() < stopping_m;
  const double kept_m = decision_options_.standstill_gap_m +
                        decision_options_.headway_s * lead.speed_mps + kNotYetKept_m;
  const bool has_room = lead.gap_m > room_ahead_m(speed_mps, lead.speed_mps) - kEasedRoom_m;
  const bool stands = lead.speed_mps < kStandingLead_mps;
  const bool brakes = lead.acceleration_mps2 < kBrakesHard_mps2;
  if (stops || lead.gap_m > kept_m || !has_room || stands || brakes) return;
  const double closing_mps = std::max(0.0, speed_mps - lead.speed_mps);
  const double left_m = lead.gap_m - room_ahead_m(lead.speed_mps, lead.speed_mps) + kEasedRoom_m;
  const double needed_mps2 = 0.5 * closing_mps * closing_mps / std::max(kLeastLeft_m, left_m);
  const double least_mps2 = opens ? 0.0 : -std::max(kEased_mps2, needed_mps2);
  command.acceleration_mps2 = std::max(command.acceleration_mps2, least_mps2);
}

void CruiseLaw::brake_for(const Lead& lead, double speed_mps, PlannerCommand& command) const {
  const auto braking = emergency_deceleration_mps2(speed_mps, lead);
  if (!braking) return;
  command.acceleration_mps2 = std::min(command.acceleration_mps2, -*braking);
  command.behaviour = Behaviour::emergency;
  command.reason =
      fmt::format("braking at {:.1f} m/s²: {} is {:.1f} m ahead, closing at {:.1f} m/s", *braking,
                  lead_name(lead), lead.gap_m, speed_mps - lead.speed_mps);
}

/// The cruise control cannot ask for what this halt takes, or takes by now.
void CruiseLaw::brake_for(const StopConstraint& halt, const Question& q,
                          PlannerCommand& command) const {
  const auto braking = emergency_stop_mps2(q.view.measured.speed_mps,
                                           halt.s_m + kBeforeHalt_m - q.replanner().s_m());
  if (!braking || -*braking > command.acceleration_mps2) return;
  if (!halt.is_hard && *braking <= kMostCommand_mps2) return;
  command.acceleration_mps2 = -*braking;
  command.behaviour = Behaviour::emergency;
  command.reason = fmt::format("braking at {:.1f} m/s²: {}", *braking, halt.reason);
}

/// Of a path that is kept nothing is known to be free beyond its end, and what is there is no lead.
void CruiseLaw::brake_for_no_path(const Question& q, const std::optional<Lead>& lead,
                                  const std::optional<StopConstraint>& halt,
                                  PlannerCommand& command) {
  const std::optional<double> left_m = path_left_m(q, lead, halt);
  const auto braking =
      left_m ? emergency_stop_mps2(q.view.measured.speed_mps, *left_m) : std::nullopt;
  const bool is_blocked = braking && *braking > kMostCommand_mps2;
  blocked_cycles_ = is_blocked ? blocked_cycles_ + 1 : 0;
  if (blocked_cycles_ < kBlockedCycles || q.view.measured.speed_mps < kCreeps_mps) return;
  if (-*braking > command.acceleration_mps2) return;
  command.acceleration_mps2 = -*braking;
  command.behaviour = Behaviour::emergency;
  command.reason =
      fmt::format("braking at {:.1f} m/s²: no path is clear of what is in the way{}", *braking,
                  *left_m > 0.0 ? fmt::format(" {:.1f} m ahead", *left_m) : "");
}

void CruiseLaw::overtake(const Question& q, PlannerCommand& command) const {
  if (command.behaviour == Behaviour::emergency) return;
  const Overtaking::Decision& overtaking = q.passing.overtaking;
  command.behaviour = Behaviour::pass;
  command.reason = overtaking.reason;
  if (!overtaking.falls_back) return;
  const double lead_mps =
      q.traffic.obstacles[*overtaking.overtaken].motion.at(q.view.t_s).speed_mps;
  const bool falls_behind = q.view.measured.speed_mps < lead_mps - kFallsBehind_mps;
  command.acceleration_mps2 =
      std::min(command.acceleration_mps2, falls_behind ? 0.0 : -kMostCommand_mps2);
}

}  // namespace roadbed::planning::behaviour
