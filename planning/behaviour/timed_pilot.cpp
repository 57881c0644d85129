#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "roadbed/planning/behaviour/lights_ahead.h"
#include "roadbed/planning/behaviour/maneuver_hypothesis.h"
#include "roadbed/planning/behaviour/path_profile.h"
#include "roadbed/planning/behaviour/pilot.h"
#include "roadbed/planning/behaviour/speed_search.h"
#include "roadbed/planning/behaviour/st_graph.h"
#include "roadbed/planning/behaviour/traffic.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kLeastHorizon_s = 5.0, kMostHorizon_s = 12.0;
constexpr double kBeyondGoal_s = 1.5;
constexpr double kStillFor_s = 3.0, kStill_m = 0.5;  // what counts as standing
constexpr double kTimedPassOffset_m = 0.5, kFollow_m = 20.0;
constexpr double kRoadEnd_m = 0.5;  // kept from the end of the lanes
constexpr double kNoEnd_m = 1e9;

/// What is tried beside the planner's own choice where that is not good enough: ends to the right
/// and left of the reference line.
constexpr std::array<LateralReplanner::Offsets, 6> kBeside{
    {{-0.9, -0.4}, {0.4, 0.9}, {-1.8, -1.0}, {1.0, 1.8}, {-3.5, -2.0}, {2.0, 3.5}}};
constexpr std::array<LateralReplanner::Offsets, 2> kOtherLanes{{{-3.5, -2.6}, {2.6, 3.5}}};
constexpr double kNearGoal_m = 60.0, kBesideGoal_m = 0.15;
constexpr double kBesideCost = 0.3;     // per metre of the end's offset
constexpr double kLookForPath_s = 3.0;  // the speed plan that lateral planning is told

class TimedPilot : public Pilot {
 public:
  explicit TimedPilot(const PilotSetup& setup)
      : vehicle_(setup.vehicle),
        task_(setup.task),
        predicts_(setup.pilot.predicts),
        traffic_(true_traffic(task_)) {
    goal_lines_.push_back(goal_line_on(task_.line, task_.stop_points, setup));
    for (std::size_t i = 0; i < task_.other_lines.size(); ++i) {
      goal_lines_.push_back(goal_line_on(task_.other_lines[i],
                                         i < task_.other_stop_points.size()
                                             ? task_.other_stop_points[i]
                                             : std::vector<StopPoint>{},
                                         setup));
    }
  }

  const LateralReplanner& replanner() const override { return goal_line().replanner; }

  PilotCommand decide(const PilotView& view) override {
    look_around(view.t_s);
    bodies_.emplace(traffic_, view.t_s, steps(view.t_s));
    const std::vector<Obstacle> standing = standing_at(view.t_s);
    goal_line().replanner.locate(view.measured);
    const LateralReplanner::Question question{.t_s = view.t_s,
                                              .measured = view.measured,
                                              .speed = speed_plan(view.measured),
                                              .ends = ends_at(view.measured.speed_mps),
                                              .obstacles = standing};
    const ManeuverHypothesis best = best_hypothesis(view, question);
    current_ = static_cast<std::size_t>(best.goal_line - goal_lines_.data());
    if (best.proposal) goal_line().replanner.take(*best.proposal);
    last_plan_ = best.answer.plan;
    PilotCommand command = command_of(best);
    explain(best, view, command);
    last_command_mps2_ = command.acceleration_mps2;
    return command;
  }

 private:
  GoalLine goal_line_on(const ReferenceLine& line, std::vector<StopPoint> lights,
                        const PilotSetup& setup) const {
    std::erase_if(lights, [](const auto& place) { return place.kind != StopKind::light; });
    return {
        .line = line,
        .ceiling = ceiling_of(line, vehicle_, setup.driving),
        .stretches = goal_stretches(*task_.goal, task_.road_map, line, vehicle_),
        .lights = std::move(lights),
        .replanner = {
            vehicle_,
            task_,
            line,
            {.tracking_error_m = setup.pilot.max_tracking_error_m,
             .heading_error_rad = setup.pilot.max_heading_error_rad,
             .margin_levels = {{0.2, 0.3}, {0.05, 0.12}, {-0.05, 0.2}, {-0.15, 0.2}, {-0.6, 0.12}},
             .squeezes_past = true,
             .keeps_candidates = setup.pilot.keeps_candidates}}};
  }

  GoalLine& goal_line() { return goal_lines_[current_]; }
  const GoalLine& goal_line() const { return goal_lines_[current_]; }

  void look_around(double t_s) {
    if (!predicts_) return;
    predicted_.emplace(true_traffic(task_), t_s);
    traffic_ = predicted_->traffic();
  }

  /// The planner's own choice first, then paths beside it, other lines, and all of them with more
  /// risk_level.
  ManeuverHypothesis best_hypothesis(const PilotView& view,
                                     const LateralReplanner::Question& question) {
    ManeuverHypothesis best =
        hypothesis_on(goal_line(), view, first_proposal(goal_line(), question));
    search(view, kRiskLevels.front(), best);
    std::vector<ManeuverHypothesis> all{best};
    for (const RiskLevel& risk_level : kRiskLevels) {
      for (std::size_t i = 0; i < all.size() && !is_good(best); ++i) {
        if (&risk_level != &kRiskLevels.front()) search(view, risk_level, all[i]);
        if (is_better(all[i], best)) best = all[i];
      }
      if (is_good(best)) break;
      if (&risk_level == &kRiskLevels.front()) add_others(view, question, all, best);
    }
    return best;
  }

  void add_others(const PilotView& view, const LateralReplanner::Question& question,
                  std::vector<ManeuverHypothesis>& all, ManeuverHypothesis& best) {
    if (!is_drivable(best)) add_paths_beside(view, question, kBeside, all, best);
    if (best.answer.misses_goal) add_paths_beside(view, question, kOtherLanes, all, best);
    if (!is_good(best)) add_other_lines(view, question, all, best);
  }

  /// The planner's choice; near a goal that lies beside the line, one that leads through it.
  static LateralReplanner::Proposal first_proposal(const GoalLine& on,
                                                   const LateralReplanner::Question& question) {
    for (const GoalStretch& stretch : on.stretches) {
      const double ahead_m = stretch.s_m.most - on.replanner.s_m();
      if (std::abs(stretch.d_m) < kBesideGoal_m || !(ahead_m > 0.0 && ahead_m < kNearGoal_m))
        continue;
      LateralReplanner::Proposal to_goal = on.replanner.propose(
          question, {stretch.d_m - kBesideGoal_m, stretch.d_m + kBesideGoal_m}, false);
      if (to_goal.plan.chosen) return to_goal;
    }
    return on.replanner.propose(question, {});
  }

  void add_paths_beside(const PilotView& view, const LateralReplanner::Question& question,
                        std::span<const LateralReplanner::Offsets> beside,
                        std::vector<ManeuverHypothesis>& all, ManeuverHypothesis& best) {
    for (const LateralReplanner::Offsets& offsets : beside) {
      if (is_good(best)) return;
      add(view, goal_line(), goal_line().replanner.propose(question, offsets, false), all, best);
    }
  }

  void add_other_lines(const PilotView& view, const LateralReplanner::Question& question,
                       std::vector<ManeuverHypothesis>& all, ManeuverHypothesis& best) {
    for (GoalLine& other : goal_lines_) {
      if (&other == &goal_line()) continue;
      other.replanner.locate(view.measured);
      add(view, other, first_proposal(other, question), all, best);
    }
  }

  void add(const PilotView& view, GoalLine& on, LateralReplanner::Proposal proposal,
           std::vector<ManeuverHypothesis>& all, ManeuverHypothesis& best) {
    if (!proposal.plan.chosen) return;
    all.push_back(hypothesis_on(on, view, std::move(proposal)));
    search(view, kRiskLevels.front(), all.back());
    if (is_better(all.back(), best)) best = all.back();
  }

  /// @param proposal  the path that is being driven is kept if it has no candidate.
  ManeuverHypothesis hypothesis_on(GoalLine& on, const PilotView& view,
                                   LateralReplanner::Proposal proposal) {
    if (!proposal.plan.chosen) {
      on.replanner.take(proposal);
      PathProfile profile = profile_along(on, on.replanner.path(), view);
      const double road_m = on_road_m(profile, task_.road_map);
      return {.goal_line = &on,
              .proposal = {},
              .profile = std::move(profile),
              .on_road_m = road_m,
              .answer = {},
              .lead = {}};
    }
    PathProfile profile = profile_along(on, on.replanner.path_of(proposal), view);
    const double road_m =
        proposal.beyond_the_edge_m > 0.0 ? on_road_m(profile, task_.road_map) : kNoEnd_m;
    return {.goal_line = &on,
            .proposal = std::move(proposal),
            .profile = std::move(profile),
            .on_road_m = road_m,
            .answer = {},
            .lead = {}};
  }

  PathProfile profile_along(const GoalLine& on, const PlannedPath& path,
                            const PilotView& view) const {
    return sample_path_profile(path, on.replanner.s_m(), look_ahead_m(view), on.ceiling, vehicle_);
  }

  void search(const PilotView& view, const RiskLevel& risk_level,
              ManeuverHypothesis& hypothesis) const {
    if (!hypothesis.occupancy || hypothesis.risk_level->margin_m != risk_level.margin_m) {
      auto occupancy = std::make_shared<StGraph>(hypothesis.profile, *bodies_, risk_level.margin_m);
      block_lights(view, hypothesis, *occupancy);
      hypothesis.occupancy = std::move(occupancy);
    }
    const StGraph& occupancy = *hypothesis.occupancy;
    hypothesis.answer = search_speed(question_of(view, hypothesis, occupancy), risk_level.speed);
    hypothesis.risk_level = &risk_level;
    hypothesis.cost = hypothesis.answer.cost + kBesideCost * beside_m(hypothesis);
    hypothesis.lead = lead_on(occupancy, view);
  }

  void block_lights(const PilotView& view, const ManeuverHypothesis& hypothesis,
                    StGraph& occupancy) const {
    for (const LightAhead& ahead : lights_ahead(hypothesis)) {
      block_light(ahead, view.t_s, steps(view.t_s), stopping_m(view) < ahead.line_m, occupancy);
    }
  }

  std::vector<LightAhead> lights_ahead(const ManeuverHypothesis& hypothesis) const {
    std::vector<LightAhead> ahead;
    for (const StopPoint& place : hypothesis.goal_line->lights) {
      const double line_m = ahead_of(hypothesis.profile, place.s_m) - vehicle_.front_m();
      ahead.push_back({place, task_.lights[*place.light], line_m});
    }
    return ahead;
  }

  static double stopping_m(const PilotView& view) {
    const SpeedSearchOptions usual;
    const double speed = view.measured.speed_mps;
    return speed * usual.actuator_lag_s - 0.5 * speed * speed / usual.least_mps2;
  }

  /// The slower, the nearer: a bend of a few metres wants paths that are no longer.
  static LateralReplanner::Ends ends_at(double speed_mps) {
    const double least_m = std::clamp(2.0 * speed_mps, 7.0, PlanOptions{}.min_l_m);
    return {.least_m = least_m, .most_m = 2.0 * least_m};
  }

  /// The last longitudinal plan as lateral planning understands it.
  SpeedPlan speed_plan(const VehicleState& measured) const {
    const double speed = measured.speed_mps;
    double target = speed, reached_s = kLookForPath_s;
    for (const SpeedState& state : last_plan_) {
      if (state.t_s > kLookForPath_s) break;
      target = state.speed_mps;
      reached_s = state.t_s;
    }
    return {.speed_mps = speed,
            .acceleration_mps2 = (target - speed) / std::max(1.0, reached_s),
            .target_mps = target};
  }

  /// What stands for a while, as something that stands for ever.
  std::vector<Obstacle> standing_at(double t_s) const {
    std::vector<Obstacle> standing;
    for (std::size_t i = 0; i < traffic_.obstacles.size(); ++i) {
      if (!traffic_.obstacles[i].is_there(t_s)) continue;
      const Obstacle& obstacle = traffic_.obstacles[i];
      const geometry::TrajectoryPoint now = obstacle.motion.at(t_s);
      const geometry::TrajectoryPoint later = obstacle.motion.at(t_s + kStillFor_s);
      if ((later.pose().position() - now.pose().position()).norm() > kStill_m) continue;
      standing.push_back(obstacle);
      standing.back().motion = geometry::Trajectory({now});
    }
    return standing;
  }

  double horizon_s(double t_s) const {
    const double to_goal_s = task_.goal->latest_s().value_or(t_s) - t_s;
    return std::clamp(to_goal_s + kBeyondGoal_s, kLeastHorizon_s, kMostHorizon_s);
  }

  int steps(double t_s) const {
    return static_cast<int>(std::ceil((horizon_s(t_s) + 1.0) / StGraph::kStep_s));
  }

  double look_ahead_m(const PilotView& view) const {
    const double fastest = std::max(view.measured.speed_mps, kUsual_mps) + 3.0;
    return fastest * horizon_s(view.t_s) + 20.0;
  }

  bool goal_is_past(double t_s) const {
    const std::optional<double> latest = task_.goal->latest_s();
    return latest && t_s > *latest;
  }

  SpeedSearchQuestion question_of(const PilotView& view, const ManeuverHypothesis& hypothesis,
                                  const StGraph& occupancy) const {
    const PathProfile& profile = hypothesis.profile;
    const double road_end_s_m =
        hypothesis.goal_line->line.length_m() - vehicle_.front_m() - kRoadEnd_m;
    SpeedSearchQuestion asked{
        .profile = profile,
        .occupancy = occupancy,
        .speed_mps = view.measured.speed_mps,
        .acceleration_mps2 = view.measured.acceleration_mps2,
        .last_command_mps2 = last_command_mps2_,
        .horizon_s = horizon_s(view.t_s),
        .end_m = std::min(ahead_of(profile, road_end_s_m), hypothesis.on_road_m),
        .goals = {}};
    if (goal_is_past(view.t_s) || task_.goal->states.empty()) {
      asked.most_wanted_mps = 0.0;
      return asked;
    }
    if (!hypothesis.proposal) asked.most_wanted_mps = 0.0;
    for (const GoalStretch& stretch : hypothesis.goal_line->stretches)
      asked.goals.push_back(ahead(profile, stretch, view));
    return asked;
  }

  static double ahead_of(const PathProfile& profile, double s_m) {
    if (!std::isfinite(s_m)) return s_m;
    const auto& stations = profile.station_m;
    if (s_m >= stations.back()) return profile.ahead_m.back() + s_m - stations.back();
    if (s_m <= stations.front()) return s_m - stations.front();
    const auto after = std::upper_bound(stations.begin(), stations.end(), s_m);
    const auto i = static_cast<std::size_t>(after - stations.begin());
    const double fraction = (s_m - stations[i - 1]) / (stations[i] - stations[i - 1]);
    return profile.ahead_m[i - 1] + fraction * (profile.ahead_m[i] - profile.ahead_m[i - 1]);
  }

  static GoalAhead ahead(const PathProfile& profile, const GoalStretch& stretch,
                         const PilotView& view) {
    return {.time_s = {stretch.time_s.least - view.t_s, stretch.time_s.most - view.t_s},
            .speed_mps = stretch.speed_mps,
            .ahead_m = {ahead_of(profile, stretch.s_m.least), ahead_of(profile, stretch.s_m.most)}};
  }

  static PilotCommand command_of(const ManeuverHypothesis& best) {
    PilotCommand command;
    const std::vector<SpeedState>& plan = best.answer.plan;
    const bool leads_on = plan.size() > 1;
    command.acceleration_mps2 = leads_on ? plan[1].command_mps2 : best.risk_level->speed.least_mps2;
    command.set_speed_mps = leads_on ? plan[1].speed_mps : 0.0;
    command.lead = best.lead;
    return command;
  }

  std::optional<DriveLead> lead_on(const StGraph& occupancy, const PilotView& view) const {
    const StInterval* nearest = nullptr;
    for (const StInterval& part : occupancy.at(0)) {
      if (part.obstacle == StInterval::kNoObstacle) continue;
      if (part.from_m >= 0.0 && (!nearest || part.from_m < nearest->from_m)) nearest = &part;
    }
    if (!nearest) return std::nullopt;
    const Obstacle& obstacle = traffic_.obstacles[nearest->obstacle];
    const double speed = obstacle.is_static() ? 0.0 : obstacle.motion.at(view.t_s).speed_mps;
    return DriveLead{obstacle.id, nearest->from_m, speed};
  }

  void explain(const ManeuverHypothesis& best, const PilotView& view, PilotCommand& command) const {
    if (!best.answer.is_free) {
      command.behaviour = Behaviour::emergency;
      command.reason =
          fmt::format("every speed meets something after {:.1f} s", best.answer.free_until_s);
    } else if (best.risk_level->is_emergency) {
      command.behaviour = Behaviour::emergency;
      command.reason =
          fmt::format("¼ g is not enough: {:.1f} m/s² asked for", command.acceleration_mps2);
    } else if (goal_is_past(view.t_s) || task_.goal->states.empty()) {
      command.behaviour = Behaviour::stop;
      command.reason =
          task_.goal->states.empty() ? "no goal is asked for" : "the goal's time is over";
    } else if (beside_m(best) > kTimedPassOffset_m) {
      command.behaviour = Behaviour::pass;
      command.reason =
          fmt::format("the way is free {:.1f} m beside the reference line", beside_m(best));
    } else if (const auto light = why_light_stops(lights_ahead(best), view.t_s)) {
      command.behaviour = Behaviour::yield;
      command.reason = *light;
    } else if (command.lead && command.lead->gap_m < kFollow_m) {
      command.behaviour = Behaviour::follow;
      command.reason = fmt::format("{} is {:.1f} m ahead at {:.1f} m/s", command.lead->id,
                                   command.lead->gap_m, command.lead->speed_mps);
    } else {
      command.reason =
          best.answer.reaches_goal ? "the goal is reached in time" : "the road is free";
    }
  }

  static constexpr double kUsual_mps = 50.0 / 3.6;

  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  bool predicts_;
  std::optional<PredictedTraffic> predicted_;
  Traffic traffic_;  ///< what is planned against; of the world, or of what is foreseen
  std::optional<TrafficBodies> bodies_;  ///< of the present cycle
  std::vector<GoalLine> goal_lines_;     ///< the world's line first
  std::size_t current_ = 0;              ///< that is driven
  double last_command_mps2_ = 0.0;
  std::vector<SpeedState> last_plan_;
};

}  // namespace

std::unique_ptr<Pilot> make_timed_pilot(const PilotSetup& setup) {
  return std::make_unique<TimedPilot>(setup);
}

}  // namespace roadbed::planning::behaviour
