#include "roadbed/planning/behaviour/missed_lane_change.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "roadbed/planning/maneuvers/merging.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kMustBrake_mps2 = 1.0;  // more than this: the vehicle would have to brake now
constexpr double kWaitsBelow_mps = 0.3, kWaitsForGap_s = 60.0;
constexpr double kLonger_s = 30.0, kFast_mps = 60.0 / 3.6;
constexpr int kMostTries = 4;

/// The first lane change of a route: to which lane, and how far ahead it has to be made at last.
struct NextChange {
  map::LaneId to;
  double until_m;
};

std::optional<NextChange> next_change(const Route& route) {
  double driven_m = 0.0;
  for (std::size_t i = 0; i + 1 < route.legs.size(); ++i) {
    const RouteLeg& leg = route.legs[i];
    if (leg.exit == LegExit::successor) {
      driven_m += std::abs(leg.to_s_m - leg.from_s_m);
      continue;
    }
    const double until_s_m = leg.change_window ? leg.change_window->to_s_m : leg.to_s_m;
    return NextChange{route.legs[i + 1].lane, driven_m + std::abs(until_s_m - leg.from_s_m)};
  }
  return std::nullopt;
}

}  // namespace

/// Each time that it has stood for that long.
bool MissedLaneChange::has_waited(const View& view) {
  if (!view.no_gap || view.measured.speed_mps > kWaitsBelow_mps) {
    waits_since_s_.reset();
    return false;
  }
  if (!waits_since_s_) waits_since_s_ = view.t_s;
  if (view.t_s - *waits_since_s_ < kWaitsForGap_s) return false;
  waits_since_s_ = view.t_s;
  return true;
}

/// Those that were missed before stay so: ways between which nothing has changed would take turns.
/// Nor is a way any use that asks for another change at once.
DetourAnswer MissedLaneChange::ask(const View& view) const {
  std::vector<map::LaneId> missed = task_.missed;
  missed.push_back(task_.route.legs[view.no_gap->leg + 1].lane);
  const double speed_mps = view.measured.speed_mps;
  const double room_m =
      0.5 * speed_mps * speed_mps / driving_.comfort_deceleration_mps2 + change_length_m(speed_mps);
  for (int tries = 0;; ++tries) {
    DetourAnswer answer = find_detour({.task = task_,
                                       .vehicle = vehicle_,
                                       .driving = driving_,
                                       .measured = view.measured,
                                       .t_s = view.t_s,
                                       .blockers = known_blockers(task_, view.t_s),
                                       .missed = missed});
    if (!answer.detour) return answer;
    const std::optional<NextChange> change = next_change(answer.detour->route);
    if (!change || change->until_m > room_m) return answer;
    if (tries == kMostTries) return {{}, "the next lane change comes too soon"};
    missed.push_back(change->to);
  }
}

std::optional<MissedLaneChange::Decision> MissedLaneChange::look(const View& view) {
  const bool waited = has_waited(view);
  if (!view.no_gap) return std::nullopt;
  const bool has_to_brake = view.no_gap->braking_mps2 > kMustBrake_mps2;
  const bool is_first = has_to_brake && asked_leg_ != view.no_gap->leg;
  if (!is_first && !waited) return std::nullopt;
  asked_leg_ = view.no_gap->leg;
  DetourAnswer answer = ask(view);
  if (!answer.detour) return std::nullopt;
  const bool is_worth_it = waited || answer.detour->longer_s <= kLonger_s;
  if (!is_worth_it && view.limit_mps <= kFast_mps) return std::nullopt;
  return Decision{
      "nobody leaves a gap for the lane change; " + described(*answer.detour, task_.road_map),
      *std::move(answer.detour)};
}

}  // namespace roadbed::planning::behaviour
