#include "roadbed/planning/behaviour/hypothesis_speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "roadbed/planning/behaviour/cruise_forecast.h"
#include "roadbed/planning/speed/goal_reach.h"
#include "roadbed/planning/speed/goals_on_path.h"
#include "roadbed/planning/speed/lead.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kLeastHorizon_s = 5.0, kMostHorizon_s = 12.0;
constexpr double kBeyondGoal_s = 1.5;
constexpr double kRoadEnd_m = 0.1;  // kept from the end of the lanes
constexpr double kUsual_mps = 50.0 / 3.6;
constexpr double kPassOffset_m = 0.5, kFollow_m = 20.0;
constexpr double kBesideCost = 0.3;        // per metre of the end's offset
constexpr double kForecastMargin_m = 0.1;  // as that of a lead

double stopping_m(const PlannerView& view) {
  const SpeedSearchOptions usual;
  const double speed = view.measured.speed_mps;
  return speed * usual.actuator_lag_s - 0.5 * speed * speed / usual.least_mps2;
}

std::string why_emergency(const RiskLevel& level, double command_mps2) {
  if (level.steers_hard()) {
    return fmt::format("the goal is reached in time only with more than {:.1f} m/s² to the side",
                       kUsualLateral_mps2);
  }
  if (std::abs(command_mps2) > SpeedSearchOptions{}.most_mps2) {
    return fmt::format("¼ g is not enough: {:.1f} m/s² asked for", command_mps2);
  }
  return "nothing within ¼ g and gentle bends reaches the goal or is free";
}

/// Who is nearest ahead on the path.
std::optional<DriveLead> lead_on(const StGraph& occupancy, const PlanningScene& scene) {
  const StInterval* nearest = nullptr;
  for (const StInterval& part : occupancy.at(0)) {
    if (part.obstacle == StInterval::kNoObstacle) continue;
    if (part.from_m >= 0.0 && (!nearest || part.from_m < nearest->from_m)) nearest = &part;
  }
  if (!nearest) return std::nullopt;
  const Obstacle& obstacle = scene.traffic.obstacles[nearest->obstacle];
  const double speed = obstacle.is_static() ? 0.0 : obstacle.motion.at(scene.view.t_s).speed_mps;
  return DriveLead{obstacle.id, nearest->from_m, speed};
}

}  // namespace

HypothesisSpeed::HypothesisSpeed(const PlannerSetup& setup, const DecisionOptions& cruise)
    : vehicle_(setup.vehicle), task_(setup.task), cruise_(cruise) {}

double HypothesisSpeed::horizon_s(double t_s) const {
  if (!task_.goal) return kLeastHorizon_s;
  const double to_goal_s = task_.goal->latest_s().value_or(t_s) - t_s;
  return std::clamp(to_goal_s + kBeyondGoal_s, kLeastHorizon_s, kMostHorizon_s);
}

int HypothesisSpeed::steps(double t_s) const {
  return static_cast<int>(std::ceil((horizon_s(t_s) + 1.0) / StGraph::kStep_s));
}

double HypothesisSpeed::look_ahead_m(const PlannerView& view) const {
  const double fastest = std::max(view.measured.speed_mps, kUsual_mps) + 3.0;
  return fastest * horizon_s(view.t_s) + 20.0;
}

/// Whether the time in which the goal could have been reached is over.
bool HypothesisSpeed::goal_is_past(double t_s) const {
  const std::optional<double> latest = task_.goal->latest_s();
  return latest && t_s > *latest;
}

void HypothesisSpeed::forecast(const PlanningScene& scene, ManeuverHypothesis& hypothesis) const {
  set_occupancy(scene, kForecastMargin_m, hypothesis);
  CruiseForecast forecast =
      forecast_cruise({.profile = hypothesis.profile,
                       .occupancy = *hypothesis.occupancy,
                       .speed_mps = scene.view.measured.speed_mps,
                       .acceleration_mps2 = scene.view.measured.acceleration_mps2,
                       .stop_m = end_m(scene, hypothesis),
                       .no_matter = scene.no_matter,
                       .crosses = scene.crosses,
                       .most_mps = scene.most_mps,
                       .walkers = scene.walkers},
                      cruise_);
  hypothesis.answer = std::move(forecast.drive);
  if (forecast.met) hypothesis.meeting = {*forecast.met, hypothesis.answer.free_until_s};
  hypothesis.by_cruise_law = true;
}

void HypothesisSpeed::search(const PlanningScene& scene, const RiskLevel& risk_level,
                             ManeuverHypothesis& hypothesis) const {
  if (!hypothesis.risk_level || hypothesis.risk_level->margin_m != risk_level.margin_m) {
    set_occupancy(scene, risk_level.margin_m, hypothesis);
  }
  limit_speed_in_bends(hypothesis.profile, vehicle_, risk_level.bends);
  hypothesis.answer =
      search_speed(question_of(scene, hypothesis, *hypothesis.occupancy), risk_level.speed);
  hypothesis.risk_level = &risk_level;
  hypothesis.cost = hypothesis.answer.cost + kBesideCost * beside_m(hypothesis);
  hypothesis.by_cruise_law = false;
}

bool HypothesisSpeed::may_reach_goal(const PlanningScene& scene, const RiskLevel& risk_level,
                                     const ManeuverHypothesis& hypothesis) const {
  const StGraph occupancy(hypothesis.profile, scene.bodies, risk_level.margin_m);
  return planning::may_reach_goal(question_of(scene, hypothesis, occupancy),
                                  risk_level.speed.most_mps2);
}

void HypothesisSpeed::set_occupancy(const PlanningScene& scene, double margin_m,
                                    ManeuverHypothesis& hypothesis) const {
  auto occupancy = std::make_shared<StGraph>(hypothesis.profile, scene.bodies, margin_m);
  block_lights(scene, hypothesis, *occupancy);
  hypothesis.occupancy = std::move(occupancy);
}

void HypothesisSpeed::block_lights(const PlanningScene& scene, const ManeuverHypothesis& hypothesis,
                                   StGraph& occupancy) const {
  const PlannerView& view = scene.view;
  for (const LightAhead& ahead : lights_ahead(hypothesis)) {
    block_light(ahead, view.t_s, steps(view.t_s), stopping_m(view) < ahead.line_m, occupancy);
  }
}

std::vector<LightAhead> HypothesisSpeed::lights_ahead(const ManeuverHypothesis& hypothesis) const {
  std::vector<LightAhead> ahead;
  for (const StopPoint& place : hypothesis.goal_line->lights) {
    const double line_m = hypothesis.profile.ahead_of_m(place.s_m) - vehicle_.front_m();
    ahead.push_back({place, task_.lights[*place.light], line_m});
  }
  return ahead;
}

/// Where the vehicle has to stand at the latest.
double HypothesisSpeed::end_m(const PlanningScene& scene,
                              const ManeuverHypothesis& hypothesis) const {
  const PathProfile& profile = hypothesis.profile;
  const ReferenceLine& line = hypothesis.goal_line->line;
  if (task_.goal) {
    const double end_s_m = hypothesis.goal_line->road_end_s_m - vehicle_.front_m() - kRoadEnd_m;
    return std::min(profile.ahead_of_m(end_s_m), hypothesis.on_road_m);
  }
  double end_m = profile.ahead_of_m(line.goal_s_m());
  if (scene.halt) end_m = std::min(end_m, profile.ahead_of_m(scene.halt->s_m));
  return end_m;
}

SpeedSearchQuestion HypothesisSpeed::question_of(const PlanningScene& scene,
                                                 const ManeuverHypothesis& hypothesis,
                                                 const StGraph& occupancy) const {
  const PlannerView& view = scene.view;
  SpeedSearchQuestion asked{.profile = hypothesis.profile,
                            .occupancy = occupancy,
                            .speed_mps = view.measured.speed_mps,
                            .acceleration_mps2 = view.measured.acceleration_mps2,
                            .last_command_mps2 = scene.last_command_mps2,
                            .horizon_s = horizon_s(view.t_s),
                            .end_m = end_m(scene, hypothesis),
                            .goals = {}};
  if (!task_.goal) return asked;
  if (goal_is_past(view.t_s) || task_.goal->states.empty()) {
    asked.most_wanted_mps = 0.0;
    return asked;
  }
  if (!hypothesis.has_candidate()) asked.most_wanted_mps = 0.0;
  PathGoals found = path_goals(*task_.goal, task_.road_map, hypothesis.goal_line->stretches,
                               hypothesis.profile, view.t_s);
  asked.goals = std::move(found.goals);
  asked.goal_is_off_path = found.is_off_path;
  return asked;
}

PlannerCommand HypothesisSpeed::command_of(const ManeuverHypothesis& best,
                                           const PlanningScene& scene) const {
  PlannerCommand command;
  command.acceleration_mps2 = first_command_mps2(best);
  command.set_speed_mps = best.answer.plan.size() > 1 ? best.answer.plan[1].speed_mps : 0.0;
  command.most_lateral_mps2 = best.risk_level->most_lateral_mps2;
  command.lead = lead_on(*best.occupancy, scene);
  explain(best, scene, command);
  return command;
}

void HypothesisSpeed::explain(const ManeuverHypothesis& best, const PlanningScene& scene,
                              PlannerCommand& command) const {
  const double t_s = scene.view.t_s;
  const bool has_goal = !task_.goal->states.empty();
  if (!best.answer.is_free) {
    command.behaviour = Behaviour::emergency;
    command.reason = fmt::format("no way on is free: {:.1f} s at best", best.answer.free_until_s);
  } else if (best.risk_level->is_emergency) {
    command.behaviour = Behaviour::emergency;
    command.reason = why_emergency(*best.risk_level, command.acceleration_mps2);
    command.is_news = best.risk_level->steers_hard();
  } else if (goal_is_past(t_s) || !has_goal) {
    command.behaviour = Behaviour::stop;
    command.reason = has_goal ? "the goal's time is over" : "no goal is asked for";
  } else if (beside_m(best) > kPassOffset_m) {
    command.behaviour = Behaviour::pass;
    command.reason =
        fmt::format("the way is free {:.1f} m beside the reference line", beside_m(best));
  } else if (const auto light = why_light_stops(lights_ahead(best), t_s)) {
    command.behaviour = Behaviour::yield;
    command.reason = *light;
  } else if (command.lead && command.lead->gap_m < kFollow_m) {
    command.behaviour = Behaviour::follow;
    command.reason = lead_text(command.lead->id, command.lead->gap_m, command.lead->speed_mps);
  } else {
    command.reason = best.answer.reaches_goal ? "the goal is reached in time" : "the road is free";
  }
}

}  // namespace roadbed::planning::behaviour
