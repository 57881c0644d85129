#include "roadbed/planning/behaviour/decision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kStands_mps = 0.3;
constexpr double kStopping_m = 0.3;    // this near to where it is to stop, it stops
constexpr double kMoveOffGap_m = 1.0;  // beyond the standstill gap, before following on
constexpr double kFollowSlack_mps = 2.0, kStillFollows_mps = 4.0;
constexpr double kBeyondGap_m = 3.0;  // nearer than the gap: that one is the cruise control's
constexpr double kBrakes_mps2 = 0.5;  // less is no braking
constexpr double kNeedsNone_mps = 1.0;
constexpr double kSpeedUpIn_s = 1.5;  // the cruise control speeds up by what is missing over this
constexpr double kFar_m = 1e4;

struct Option {
  SpeedTarget now, ahead;  ///< at the station, and where the actuator will have answered
  Behaviour behaviour;
  std::string reason;
};

/// Distance driven until the actuator has answered; who speeds up has to give that up before.
double preview_m(const SpeedQuestion& q, double preview_s) {
  preview_s += std::max(0.0, q.acceleration_mps2) / geometry::kLongitudinal.max_jerk_mps3;
  return std::max(0.0, (q.speed_mps + 0.5 * q.acceleration_mps2 * preview_s) * preview_s);
}

Option by_ceiling(const SpeedQuestion& q, double ahead_m) {
  const SpeedTarget now = q.ceiling.at(q.s_m);
  return {now, q.ceiling.at(q.s_m + ahead_m), Behaviour::cruise,
          fmt::format("at most {:.1f} m/s here", now.speed_mps)};
}

Option by_goal(const SpeedQuestion& q, double ahead_m, double deceleration) {
  const double distance = q.goal_s_m - q.s_m;
  return {stopping_speed(distance, deceleration), stopping_speed(distance - ahead_m, deceleration),
          Behaviour::stop, fmt::format("the goal is {:.1f} m ahead", std::max(0.0, distance))};
}

Option by_halt(const SpeedQuestion& q, double ahead_m) {
  const double distance = q.halt->s_m - q.s_m;
  return {stopping_speed(distance, q.halt->deceleration_mps2),
          stopping_speed(distance - ahead_m, q.halt->deceleration_mps2), Behaviour::yield,
          q.halt->reason};
}

/// What is seen goes along with the vehicle, which stops within it whatever comes into sight.
Option by_sight(const SpeedQuestion& q, double deceleration) {
  const double most_mps = stopping_speed(*q.seen_ahead_m, deceleration).speed_mps;
  return {{most_mps, 0.0},
          {most_mps, 0.0},
          Behaviour::cruise,
          fmt::format("at most {:.1f} m/s as {:.0f} m ahead are seen", most_mps, *q.seen_ahead_m)};
}

/// The one of them who counts is the one at whom the vehicle is slowest, named as the nearest.
Option by_walkers(const SpeedQuestion& q, double ahead_m, double deceleration) {
  const SpeedTarget now = speed_before_walkers(q.walkers, 0.0, deceleration);
  const auto next = std::ranges::find_if(q.walkers, [&](const HiddenWalker& walker) {
    return speed_before_walkers({&walker, 1}, 0.0, deceleration).speed_mps == now.speed_mps;
  });
  return {
      now, speed_before_walkers(q.walkers, ahead_m, deceleration), Behaviour::cruise,
      fmt::format("at most {:.1f} m/s {:.0f} m ahead, where somebody hidden may step out {:.1f} m "
                  "beside the way",
                  next->most_mps, next->ahead_m, next->aside_m)};
}

Option by_creeping(const SpeedQuestion& q) {
  return {{*q.creep_mps, 0.0},
          {*q.creep_mps, 0.0},
          Behaviour::yield,
          "creeps, as somebody hidden may come"};
}

/// Nothing is feasible: stop before the last path ends. A cycle or two of it are hardly felt.
Option by_path(const SpeedQuestion& q, double ahead_m, double deceleration) {
  const double left_m = *q.path_left_m;
  return {stopping_speed(left_m, deceleration), stopping_speed(left_m - ahead_m, deceleration),
          Behaviour::stop,
          fmt::format("no candidate is feasible, the last path is good for {:.1f} m", left_m)};
}

/// Until a braking lead will stand if it brakes on; far for one that does not brake.
double stopping_way_m(const Lead& lead) {
  if (lead.acceleration_mps2 > -kBrakes_mps2 || lead.speed_mps <= 0.0) return kFar_m;
  return 0.5 * lead.speed_mps * lead.speed_mps / -lead.acceleration_mps2;
}

Option by_approach(const SpeedQuestion& q, const Lead& lead, const DecisionOptions& options) {
  const double lead_mps = std::max(0.0, lead.speed_mps);
  const double driven_m = preview_m(q, options.preview_s);
  const double closing_m = std::max(0.0, driven_m - lead_mps * options.preview_s);
  return {approach_speed(lead, {}, options),
          approach_speed(lead, {.driven_m = driven_m, .closed_m = closing_m}, options),
          Behaviour::follow,
          {}};
}

Option by_lead(const SpeedQuestion& q, const DecisionOptions& options) {
  Option option = by_approach(q, *q.lead, options);
  option.reason = lead_text(q.lead_name, q.lead->gap_m, q.lead->speed_mps);
  return option;
}

Option by_letting_in(const SpeedQuestion& q, const DecisionOptions& options) {
  Option option = by_approach(q, *q.let_in, options);
  option.behaviour = Behaviour::yield;
  option.reason = q.let_in_reason;
  return option;
}

std::vector<Option> options_of(const SpeedQuestion& q, const DecisionOptions& options) {
  const double ahead_m = preview_m(q, options.preview_s);
  std::vector<Option> all{by_ceiling(q, ahead_m), by_goal(q, ahead_m, options.deceleration_mps2)};
  if (q.halt) all.push_back(by_halt(q, ahead_m));
  if (q.seen_ahead_m) all.push_back(by_sight(q, options.most_deceleration_mps2));
  if (!q.walkers.empty()) all.push_back(by_walkers(q, ahead_m, options.deceleration_mps2));
  if (q.creep_mps) all.push_back(by_creeping(q));
  if (q.path_left_m) all.push_back(by_path(q, ahead_m, options.most_deceleration_mps2));
  if (q.lead) all.push_back(by_lead(q, options));
  if (q.let_in) all.push_back(by_letting_in(q, options));
  return all;
}

const Option& slowest(const std::vector<Option>& options) {
  return *std::ranges::min_element(options, {},
                                   [](const Option& option) { return option.now.speed_mps; });
}

/// The planned deceleration is that of a vehicle at the planned speed; a slower one needs none.
double feed_forward_mps2(const std::vector<Option>& options, double speed_mps) {
  double least = 0.0;
  for (const Option& option : options) {
    const double missing_mps = option.ahead.speed_mps - speed_mps;
    const double share = std::clamp(1.0 - missing_mps / kNeedsNone_mps, 0.0, 1.0);
    least = std::min(least, share * option.ahead.acceleration_mps2);
  }
  return least;
}

bool is_close_to(const std::optional<Lead>& lead, const DecisionOptions& options) {
  return lead && lead->gap_m < options.standstill_gap_m + kMoveOffGap_m &&
         lead->speed_mps < kStands_mps;
}

bool is_at_rest(const SpeedQuestion& q, const DecisionOptions& options) {
  if (q.speed_mps > kStands_mps) return false;
  if (q.goal_s_m - q.s_m < kStopping_m) return true;
  if (q.halt && q.halt->s_m - q.s_m < kStopping_m) return true;
  if (q.path_left_m && *q.path_left_m < kStopping_m) return true;
  return is_close_to(q.lead, options) || is_close_to(q.let_in, options);
}

}  // namespace

SpeedTarget approach_speed(const Lead& lead, const Approached& since,
                           const DecisionOptions& options) {
  const double lead_mps = std::max(0.0, lead.speed_mps);
  const double free_m = lead.gap_m - options.standstill_gap_m - options.headway_s * lead_mps;
  const double stop_m = lead.gap_m - options.standstill_gap_m + stopping_way_m(lead);
  SpeedTarget target = stopping_speed(free_m - since.closed_m + kBeyondGap_m,
                                      options.deceleration_mps2, options.closing_s);
  target.speed_mps += lead_mps;
  const SpeedTarget stop = stopping_speed(stop_m - since.driven_m, options.deceleration_mps2);
  return stop.speed_mps < target.speed_mps ? stop : target;
}

SpeedAnswer choose_speed(const SpeedQuestion& question, const DecisionOptions& options) {
  const std::vector<Option> all = options_of(question, options);
  const Option& now = slowest(all);
  SpeedAnswer answer{.set = {.speed_mps = now.now.speed_mps,
                             .acceleration_mps2 = feed_forward_mps2(all, question.speed_mps)},
                     .behaviour = now.behaviour,
                     .reason = now.reason,
                     .hold = is_at_rest(question, options)};
  const double slack_mps = question.follows ? kStillFollows_mps : kFollowSlack_mps;
  if (question.lead && now.behaviour == Behaviour::cruise &&
      all.back().now.speed_mps < now.now.speed_mps + slack_mps) {
    answer.behaviour = Behaviour::follow;
    answer.reason = all.back().reason;
  }
  answer.set.speed_mps =
      std::min(answer.set.speed_mps, question.speed_mps + kSpeedUpIn_s * options.acceleration_mps2);
  return answer;
}

}  // namespace roadbed::planning::behaviour
