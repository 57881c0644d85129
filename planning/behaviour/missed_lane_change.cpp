#include "roadbed/planning/behaviour/missed_lane_change.h"

#include <utility>

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kMustBrake_mps2 = 1.0;  // more than this: the vehicle would have to brake now
constexpr double kWaitsBelow_mps = 0.3, kWaitsForGap_s = 60.0;
constexpr double kLonger_s = 30.0, kFast_mps = 60.0 / 3.6;

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

DetourAnswer MissedLaneChange::ask(const View& view) const {
  return find_detour({.task = task_,
                      .vehicle = vehicle_,
                      .driving = driving_,
                      .measured = view.measured,
                      .t_s = view.t_s,
                      .blockers = known_blockers(task_, view.t_s),
                      .closed = {task_.route.legs[view.no_gap->leg + 1].lane}});
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
