#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "roadbed/tools/simulation/attempt.h"
#include "roadbed/tools/simulation/closed_loop.h"
#include "roadbed/tools/simulation/driven_way.h"
#include "roadbed/tools/simulation/lights_ahead.h"
#include "roadbed/tools/simulation/pilot.h"
#include "roadbed/tools/simulation/speed_search.h"
#include "roadbed/tools/simulation/traffic.h"
#include "roadbed/tools/simulation/way_occupancy.h"

namespace roadbed::tools {
namespace {

constexpr double kLeastHorizon_s = 5.0, kMostHorizon_s = 12.0;
constexpr double kBeyondGoal_s = 1.5;
constexpr double kStillFor_s = 3.0, kStill_m = 0.5;  // what counts as standing
constexpr double kTimedPassOffset_m = 0.5, kFollow_m = 20.0;
constexpr double kRoadEnd_m = 0.5;  // kept from the end of the lanes
constexpr double kNoEnd_m = 1e9;

/// What is tried beside the planner's own choice where that is not good enough: ends to the right
/// and left of the reference line.
constexpr std::array<PathKeeper::Offsets, 6> kBeside{
    {{-0.9, -0.4}, {0.4, 0.9}, {-1.8, -1.0}, {1.0, 1.8}, {-3.5, -2.0}, {2.0, 3.5}}};
constexpr std::array<PathKeeper::Offsets, 2> kOtherLanes{{{-3.5, -2.6}, {2.6, 3.5}}};
constexpr double kNearGoal_m = 60.0, kBesideGoal_m = 0.15;
constexpr double kBesideCost = 0.3;     // per metre of the end's offset
constexpr double kLookForPath_s = 3.0;  // the speed plan that lateral planning is told

class TimedPilot : public Pilot {
 public:
  TimedPilot(const Scenario& scenario, const World& world, const LoopOptions& options)
      : scenario_(scenario),
        world_(world),
        predicts_(options.predicts),
        traffic_(true_traffic(world)) {
    courses_.push_back(course_on(world.line, world.waiting_places, options));
    for (std::size_t i = 0; i < world.other_lines.size(); ++i) {
      courses_.push_back(course_on(world.other_lines[i],
                                   i < world.other_waiting_places.size()
                                       ? world.other_waiting_places[i]
                                       : std::vector<WaitingPlace>{},
                                   options));
    }
  }

  const PathKeeper& keeper() const override { return course().keeper; }

  PilotCommand decide(const PilotView& view) override {
    look_around(view.t_s);
    bodies_.emplace(traffic_, view.t_s, steps(view.t_s));
    const std::vector<planning::Obstacle> standing = standing_at(view.t_s);
    course().keeper.locate(view.measured);
    const PathKeeper::Question question{.t_s = view.t_s,
                                        .measured = view.measured,
                                        .speed = speed_plan(view.measured),
                                        .ends = ends_at(view.measured.motion.speed_mps),
                                        .obstacles = standing};
    const Attempt best = best_attempt(view, question);
    current_ = static_cast<std::size_t>(best.course - courses_.data());
    if (best.proposal) course().keeper.take(*best.proposal);
    last_plan_ = best.answer.plan;
    PilotCommand command = command_of(best);
    explain(best, view, command);
    last_command_mps2_ = command.acceleration_mps2;
    return command;
  }

 private:
  Course course_on(const planning::ReferenceLine& line, std::vector<WaitingPlace> lights,
                   const LoopOptions& options) const {
    std::erase_if(lights, [](const auto& place) { return place.kind != WaitingKind::light; });
    return {
        .line = line,
        .ceiling = ceiling_of(scenario_, line),
        .stretches = goal_stretches(*world_.goal, world_.road_map, line, scenario_.vehicle),
        .lights = std::move(lights),
        .keeper = {scenario_,
                   world_,
                   line,
                   {.tracking_error_m = options.max_tracking_error_m,
                    .heading_error_rad = options.max_heading_error_rad,
                    .rooms = {{0.2, 0.3}, {0.05, 0.12}, {-0.05, 0.2}, {-0.15, 0.2}, {-0.6, 0.12}},
                    .squeezes_past = true,
                    .keeps_candidates = options.keeps_candidates}}};
  }

  Course& course() { return courses_[current_]; }
  const Course& course() const { return courses_[current_]; }

  void look_around(double t_s) {
    if (!predicts_) return;
    foreseen_.emplace(true_traffic(world_), t_s);
    traffic_ = foreseen_->traffic();
  }

  /// The planner's own choice first, then paths beside it, other lines, and all of them with more
  /// daring.
  Attempt best_attempt(const PilotView& view, const PathKeeper::Question& question) {
    Attempt best = attempt_on(course(), view, first_proposal(course(), question));
    search(view, kDarings.front(), best);
    std::vector<Attempt> all{best};
    for (const Daring& daring : kDarings) {
      for (std::size_t i = 0; i < all.size() && !is_good(best); ++i) {
        if (&daring != &kDarings.front()) search(view, daring, all[i]);
        if (is_better(all[i], best)) best = all[i];
      }
      if (is_good(best)) break;
      if (&daring == &kDarings.front()) add_others(view, question, all, best);
    }
    return best;
  }

  void add_others(const PilotView& view, const PathKeeper::Question& question,
                  std::vector<Attempt>& all, Attempt& best) {
    if (!is_drivable(best)) add_paths_beside(view, question, kBeside, all, best);
    if (best.answer.misses_goal) add_paths_beside(view, question, kOtherLanes, all, best);
    if (!is_good(best)) add_other_courses(view, question, all, best);
  }

  /// The planner's choice; near a goal that lies beside the line, one that leads through it.
  static PathKeeper::Proposal first_proposal(const Course& on,
                                             const PathKeeper::Question& question) {
    for (const GoalStretch& stretch : on.stretches) {
      const double ahead_m = stretch.s_m.most - on.keeper.s_m();
      if (std::abs(stretch.d_m) < kBesideGoal_m || !(ahead_m > 0.0 && ahead_m < kNearGoal_m))
        continue;
      PathKeeper::Proposal to_goal = on.keeper.propose(
          question, {stretch.d_m - kBesideGoal_m, stretch.d_m + kBesideGoal_m}, false);
      if (to_goal.plan.chosen) return to_goal;
    }
    return on.keeper.propose(question, {});
  }

  void add_paths_beside(const PilotView& view, const PathKeeper::Question& question,
                        std::span<const PathKeeper::Offsets> beside, std::vector<Attempt>& all,
                        Attempt& best) {
    for (const PathKeeper::Offsets& offsets : beside) {
      if (is_good(best)) return;
      add(view, course(), course().keeper.propose(question, offsets, false), all, best);
    }
  }

  void add_other_courses(const PilotView& view, const PathKeeper::Question& question,
                         std::vector<Attempt>& all, Attempt& best) {
    for (Course& other : courses_) {
      if (&other == &course()) continue;
      other.keeper.locate(view.measured);
      add(view, other, first_proposal(other, question), all, best);
    }
  }

  void add(const PilotView& view, Course& on, PathKeeper::Proposal proposal,
           std::vector<Attempt>& all, Attempt& best) {
    if (!proposal.plan.chosen) return;
    all.push_back(attempt_on(on, view, std::move(proposal)));
    search(view, kDarings.front(), all.back());
    if (is_better(all.back(), best)) best = all.back();
  }

  /// @param proposal  the path that is being driven is kept if it has no candidate.
  Attempt attempt_on(Course& on, const PilotView& view, PathKeeper::Proposal proposal) {
    if (!proposal.plan.chosen) {
      on.keeper.take(proposal);
      DrivenWay way = way_along(on, on.keeper.path(), view);
      const double road_m = on_road_m(way, world_.road_map);
      return {.course = &on,
              .proposal = {},
              .way = std::move(way),
              .on_road_m = road_m,
              .answer = {},
              .lead = {}};
    }
    DrivenWay way = way_along(on, on.keeper.path_of(proposal), view);
    const double road_m =
        proposal.beyond_the_edge_m > 0.0 ? on_road_m(way, world_.road_map) : kNoEnd_m;
    return {.course = &on,
            .proposal = std::move(proposal),
            .way = std::move(way),
            .on_road_m = road_m,
            .answer = {},
            .lead = {}};
  }

  DrivenWay way_along(const Course& on, const PlannedPath& path, const PilotView& view) const {
    return sample_way(path, on.keeper.s_m(), look_ahead_m(view), on.ceiling, scenario_.vehicle);
  }

  void search(const PilotView& view, const Daring& daring, Attempt& attempt) const {
    if (!attempt.occupancy || attempt.daring->margin_m != daring.margin_m) {
      auto occupancy = std::make_shared<WayOccupancy>(attempt.way, *bodies_, daring.margin_m);
      block_lights(view, attempt, *occupancy);
      attempt.occupancy = std::move(occupancy);
    }
    const WayOccupancy& occupancy = *attempt.occupancy;
    attempt.answer = search_speed(question_of(view, attempt, occupancy), daring.speed);
    attempt.daring = &daring;
    attempt.cost = attempt.answer.cost + kBesideCost * beside_m(attempt);
    attempt.lead = lead_on(occupancy, view);
  }

  void block_lights(const PilotView& view, const Attempt& attempt, WayOccupancy& occupancy) const {
    for (const LightAhead& ahead : lights_ahead(attempt)) {
      block_light(ahead, view.t_s, steps(view.t_s), stopping_m(view) < ahead.line_m, occupancy);
    }
  }

  std::vector<LightAhead> lights_ahead(const Attempt& attempt) const {
    std::vector<LightAhead> ahead;
    for (const WaitingPlace& place : attempt.course->lights) {
      const double line_m = ahead_of(attempt.way, place.s_m) - scenario_.vehicle.front_m();
      ahead.push_back({place, scenario_.lights[*place.light], line_m});
    }
    return ahead;
  }

  static double stopping_m(const PilotView& view) {
    const SpeedSearchOptions usual;
    const double speed = view.measured.motion.speed_mps;
    return speed * usual.actuator_lag_s - 0.5 * speed * speed / usual.least_mps2;
  }

  /// The slower, the nearer: a bend of a few metres wants paths that are no longer.
  static PathKeeper::Ends ends_at(double speed_mps) {
    const double least_m = std::clamp(2.0 * speed_mps, 7.0, planning::PlanOptions{}.min_l_m);
    return {.least_m = least_m, .most_m = 2.0 * least_m};
  }

  /// The last longitudinal plan as lateral planning understands it.
  planning::SpeedPlan speed_plan(const VehicleState& measured) const {
    const double speed = measured.motion.speed_mps;
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
  std::vector<planning::Obstacle> standing_at(double t_s) const {
    std::vector<planning::Obstacle> standing;
    for (std::size_t i = 0; i < traffic_.obstacles.size(); ++i) {
      if (!traffic_.is_there(i, t_s)) continue;
      const planning::Obstacle& obstacle = traffic_.obstacles[i];
      const geometry::TrajectoryPoint now = obstacle.motion.at(t_s);
      const geometry::TrajectoryPoint later = obstacle.motion.at(t_s + kStillFor_s);
      if ((later.pose().position() - now.pose().position()).norm() > kStill_m) continue;
      standing.push_back(obstacle);
      standing.back().motion = geometry::Trajectory({now});
    }
    return standing;
  }

  double horizon_s(double t_s) const {
    const double to_goal_s = world_.goal->latest_s().value_or(t_s) - t_s;
    return std::clamp(to_goal_s + kBeyondGoal_s, kLeastHorizon_s, kMostHorizon_s);
  }

  int steps(double t_s) const {
    return static_cast<int>(std::ceil((horizon_s(t_s) + 1.0) / WayOccupancy::kStep_s));
  }

  double look_ahead_m(const PilotView& view) const {
    const double fastest = std::max(view.measured.motion.speed_mps, kUsual_mps) + 3.0;
    return fastest * horizon_s(view.t_s) + 20.0;
  }

  bool goal_is_past(double t_s) const {
    const std::optional<double> latest = world_.goal->latest_s();
    return latest && t_s > *latest;
  }

  SpeedSearchQuestion question_of(const PilotView& view, const Attempt& attempt,
                                  const WayOccupancy& occupancy) const {
    const DrivenWay& way = attempt.way;
    const double road_end_s_m =
        attempt.course->line.length_m() - scenario_.vehicle.front_m() - kRoadEnd_m;
    SpeedSearchQuestion asked{.way = way,
                              .occupancy = occupancy,
                              .speed_mps = view.measured.motion.speed_mps,
                              .acceleration_mps2 = view.measured.acceleration_mps2,
                              .last_command_mps2 = last_command_mps2_,
                              .horizon_s = horizon_s(view.t_s),
                              .end_m = std::min(ahead_of(way, road_end_s_m), attempt.on_road_m),
                              .goals = {}};
    if (goal_is_past(view.t_s) || world_.goal->states.empty()) {
      asked.most_wanted_mps = 0.0;
      return asked;
    }
    if (!attempt.proposal) asked.most_wanted_mps = 0.0;
    for (const GoalStretch& stretch : attempt.course->stretches)
      asked.goals.push_back(ahead(way, stretch, view));
    return asked;
  }

  static double ahead_of(const DrivenWay& way, double s_m) {
    if (!std::isfinite(s_m)) return s_m;
    const auto& stations = way.station_m;
    if (s_m >= stations.back()) return way.ahead_m.back() + s_m - stations.back();
    if (s_m <= stations.front()) return s_m - stations.front();
    const auto after = std::upper_bound(stations.begin(), stations.end(), s_m);
    const auto i = static_cast<std::size_t>(after - stations.begin());
    const double share = (s_m - stations[i - 1]) / (stations[i] - stations[i - 1]);
    return way.ahead_m[i - 1] + share * (way.ahead_m[i] - way.ahead_m[i - 1]);
  }

  static GoalAhead ahead(const DrivenWay& way, const GoalStretch& stretch, const PilotView& view) {
    return {.time_s = {stretch.time_s.least - view.t_s, stretch.time_s.most - view.t_s},
            .speed_mps = stretch.speed_mps,
            .ahead_m = {ahead_of(way, stretch.s_m.least), ahead_of(way, stretch.s_m.most)}};
  }

  static PilotCommand command_of(const Attempt& best) {
    PilotCommand command;
    const std::vector<SpeedState>& plan = best.answer.plan;
    const bool leads_on = plan.size() > 1;
    command.acceleration_mps2 = leads_on ? plan[1].command_mps2 : best.daring->speed.least_mps2;
    command.set_speed_mps = leads_on ? plan[1].speed_mps : 0.0;
    command.lead = best.lead;
    return command;
  }

  std::optional<DriveLead> lead_on(const WayOccupancy& occupancy, const PilotView& view) const {
    const Blocked* nearest = nullptr;
    for (const Blocked& part : occupancy.at(0)) {
      if (part.obstacle == Blocked::kNoObstacle) continue;
      if (part.from_m >= 0.0 && (!nearest || part.from_m < nearest->from_m)) nearest = &part;
    }
    if (!nearest) return std::nullopt;
    const planning::Obstacle& obstacle = traffic_.obstacles[nearest->obstacle];
    const double speed = obstacle.is_static() ? 0.0 : obstacle.motion.at(view.t_s).speed_mps;
    return DriveLead{obstacle.id, nearest->from_m, speed};
  }

  void explain(const Attempt& best, const PilotView& view, PilotCommand& command) const {
    if (!best.answer.is_free) {
      command.behaviour = Behaviour::emergency;
      command.reason =
          fmt::format("every speed meets something after {:.1f} s", best.answer.free_until_s);
    } else if (best.daring->is_emergency) {
      command.behaviour = Behaviour::emergency;
      command.reason =
          fmt::format("¼ g is not enough: {:.1f} m/s² asked for", command.acceleration_mps2);
    } else if (goal_is_past(view.t_s) || world_.goal->states.empty()) {
      command.behaviour = Behaviour::stop;
      command.reason =
          world_.goal->states.empty() ? "no goal is asked for" : "the goal's time is over";
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

  const Scenario& scenario_;
  const World& world_;
  bool predicts_;
  std::optional<ForeseenTraffic> foreseen_;
  Traffic traffic_;  ///< what is planned against; of the world, or of what is foreseen
  std::optional<TrafficBodies> bodies_;  ///< of the present cycle
  std::vector<Course> courses_;          ///< the world's line first
  std::size_t current_ = 0;              ///< that is driven
  double last_command_mps2_ = 0.0;
  std::vector<SpeedState> last_plan_;
};

}  // namespace

std::unique_ptr<Pilot> make_timed_pilot(const Scenario& scenario, const World& world,
                                        const LoopOptions& options) {
  return std::make_unique<TimedPilot>(scenario, world, options);
}

}  // namespace roadbed::tools
