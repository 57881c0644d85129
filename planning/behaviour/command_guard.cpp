#include "roadbed/planning/behaviour/command_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "roadbed/planning/obstacles/reachable_set.h"
#include "roadbed/planning/obstacles/traffic.h"
#include "roadbed/planning/speed/safe_stop.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kHeldFor_s = 0.5;     // as it is foreseen; the next cycle decides anew
constexpr double kMatters_mps2 = 0.1;  // less is not worth a word

/// Whether somebody is foreseen on the path within a time.
bool comes_into_the_way(std::size_t obstacle, const StGraph& occupancy, double within_s) {
  const int steps = static_cast<int>(std::ceil(within_s / StGraph::kStep_s));
  for (int k = 0; k <= steps; ++k) {
    const auto is_his = [&](const StInterval& part) { return part.obstacle == obstacle; };
    if (std::ranges::any_of(occupancy.at(k), is_his)) return true;
  }
  return false;
}

/// Those near enough to be reached, each once.
std::vector<MayBeMet> who_may_be_met(const ManeuverHypothesis& best, const PlanningScene& scene,
                                     const DrivingTask& task, double within_s) {
  const geometry::Rectangle& body = best.profile.body.front();
  const double t_s = scene.view.t_s, own_m = scene.view.measured.speed_mps * within_s;
  const double sets_off_m = 0.5 * task.others_within->max_acceleration_mps2 * within_s * within_s;
  std::vector<MayBeMet> met;
  for (const auto& [i, there] : bodies_there(task.obstacles, t_s)) {
    const Obstacle& other = task.obstacles[i];
    if (i < scene.no_matter.size() && scene.no_matter[i]) continue;
    const Eigen::Vector2d apart = there.centre - body.centre;
    if (apart.dot(body.axis) < body.half_length_m) continue;
    const double his_m = (other.is_static() ? 0.0 : other.motion.at(t_s).speed_mps) * within_s;
    if (apart.norm() > own_m + his_m + sets_off_m + body.radius_m() + there.radius_m()) continue;
    const bool crosses = i < scene.crosses.size() && scene.crosses[i];
    if (crosses && !comes_into_the_way(i, *best.occupancy, within_s)) continue;
    ReachableSet set(task.road_map, other, t_s, within_s, *task.others_within);
    if (set.may_touch(body, 0.0, 0.0)) continue;  // nothing can be done about it any more
    met.push_back({i, std::move(set)});
  }
  return met;
}

/// Holds a command for a while.
std::vector<SpeedState> held(const StopQuestion& from, double command_mps2) {
  std::vector<SpeedState> drive;
  for (double t_s = 0.0; t_s < kHeldFor_s + 1e-9; t_s += StGraph::kStep_s) {
    const double speed_mps = std::max(0.0, from.speed_mps + command_mps2 * t_s);
    drive.push_back({.t_s = t_s,
                     .ahead_m = 0.5 * (from.speed_mps + speed_mps) * t_s,
                     .speed_mps = speed_mps,
                     .acceleration_mps2 = speed_mps > 0.0 ? command_mps2 : 0.0,
                     .command_mps2 = command_mps2});
  }
  return drive;
}

void explain(const Obstacle& who, const SafeCommand& safe, PlannerCommand& command) {
  const bool follows_him =
      command.behaviour == Behaviour::follow && command.lead && command.lead->id == who.id;
  if (!follows_him && command.behaviour != Behaviour::emergency) {
    command.behaviour = Behaviour::yield;
  }
  command.reason = fmt::format("{} {} may come into the way{}", who.kind, who.id,
                               safe.is_safe ? "" : ", and no stop before is sure");
}

}  // namespace

void CommandGuard::look(const ManeuverHypothesis& best, const PlanningScene& scene,
                        PlannerCommand& command) {
  if (!task_.others_within || task_.goal || best.maneuver == Maneuver::overtake) return;
  const VehicleState& measured = scene.view.measured;
  StopQuestion question{.profile = best.profile,
                        .speed_mps = measured.speed_mps,
                        .acceleration_mps2 = measured.acceleration_mps2};
  const double wanted_mps2 = command.acceleration_mps2;
  const std::vector<MayBeMet> others =
      who_may_be_met(best, scene, task_, stop_s(question, wanted_mps2));
  question.others = others;
  const SafeCommand safe = safe_command(question, wanted_mps2);
  const bool is_lost = std::exchange(could_stop_, safe.is_safe) && !safe.is_safe;
  if (safe.command_mps2 >= wanted_mps2) return;
  command.acceleration_mps2 = safe.command_mps2;
  command.drive = held(question, safe.command_mps2);
  if (wanted_mps2 - safe.command_mps2 <= kMatters_mps2) return;
  explain(task_.obstacles[others[*safe.who].obstacle], safe, command);
  command.is_news = command.is_news || is_lost;
}

}  // namespace roadbed::planning::behaviour
