#include "roadbed/planning/behaviour/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/planning/behaviour/blocked_road.h"
#include "roadbed/planning/behaviour/command_guard.h"
#include "roadbed/planning/behaviour/command_hold.h"
#include "roadbed/planning/behaviour/cruise_law.h"
#include "roadbed/planning/behaviour/goal_lines.h"
#include "roadbed/planning/behaviour/hypotheses.h"
#include "roadbed/planning/behaviour/hypothesis_speed.h"
#include "roadbed/planning/behaviour/missed_lane_change.h"
#include "roadbed/planning/behaviour/path_queries.h"
#include "roadbed/planning/maneuvers/lane_passing.h"
#include "roadbed/planning/maneuvers/letting_in.h"
#include "roadbed/planning/maneuvers/merging.h"
#include "roadbed/planning/maneuvers/overtaking.h"
#include "roadbed/planning/obstacles/traffic.h"
#include "roadbed/planning/speed/lead.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kStillFor_s = 3.0, kStill_m = 0.5;  // what counts as standing
constexpr double kLookForPath_s = 3.0;               // the speed plan that lateral planning is told
constexpr double kSettingOff_mps = 1.0, kSettingOff_mps2 = 1.0;

/// The slower, the nearer: a bend of a few metres wants paths that are no longer.
LateralReplanner::Ends ends_before_goal(double speed_mps) {
  const double least_m = std::clamp(2.0 * speed_mps, 7.0, PlanOptions{}.min_l_m);
  return {.least_m = least_m, .most_m = 2.0 * least_m};
}

/// The faster, the farther: the paper's 30 m are a second of a motorway, in which nothing beside
/// the line's middle is worth the lateral acceleration of coming back.
LateralReplanner::Ends ends_on_route(double speed_mps) {
  constexpr double kFrom_mps = 12.0;
  const double farther = std::max(1.0, speed_mps / kFrom_mps);
  return {.least_m = farther * PlanOptions{}.min_l_m, .most_m = farther * PlanOptions{}.max_l_m};
}

}  // namespace

class Planner::Impl {
 public:
  explicit Impl(const PlannerSetup& setup)
      : vehicle_(setup.vehicle),
        task_(setup.task),
        clearance_m_(setup.driving.clearance_m),
        lines_(setup),
        cruise_(setup),
        overtaking_(vehicle_, task_, lines_.first().ceiling),
        lane_passing_(vehicle_, task_, lines_.first().ceiling),
        merging_(vehicle_, task_, lines_.first().ceiling),
        letting_in_(vehicle_, task_),
        speed_(setup, cruise_.options()),
        hypotheses_(setup, lines_, speed_),
        blocked_road_(vehicle_, setup.driving, task_),
        missed_change_(vehicle_, setup.driving, task_),
        guard_(task_) {}

  const LateralReplanner& replanner() const { return lines_.driven().replanner; }

  PlannerCommand decide(const PlannerView& view) {
    look(view);
    lines_.driven().replanner.locate(view.measured);
    const PassingDecision passing = passing_at(view);
    if (!task_.goal) lines_.drive_along(merging_, passing.merging.along, view.measured);
    const PlanningScene scene = scene_at(view, passing);
    const std::vector<Obstacle> obstacles = obstacles_to_plan_for(scene);
    const ManeuverHypothesis best = hypotheses_.best(scene, question_at(view, obstacles), passing);
    take(best);
    PlannerCommand command =
        task_.goal ? speed_.command_of(best, scene) : by_cruise_law(best, scene, passing);
    const double law_mps2 = command.acceleration_mps2;
    if (!task_.goal && !best.by_cruise_law) give_way(best, command);
    command.hypotheses = hypotheses_.take_outcomes();
    command.drive = last_plan_;
    guard_.look(best, scene, command);
    if (!task_.goal) hold_.look(view.t_s, law_mps2, command);
    if (!task_.goal) look_for_detour(view, passing.merging, command);
    view.speed_controller.sent(command.acceleration_mps2);
    last_command_mps2_ = command.acceleration_mps2;
    last_set_speed_mps_ = command.set_speed_mps;
    return command;
  }

 private:
  // What will be where.

  void look(const PlannerView& view) {
    traffic_ = Traffic{task_.obstacles};
    if (task_.sight_m) sight_.emplace(sight_at(view));
    if (task_.goal) return;
    kept_from_ = with_room_beside_cyclists(
        traffic_.obstacles, view.t_s, geometry::body_at(view.measured.map_from_vehicle, vehicle_),
        clearance_m_);
    keep_parked(view.t_s);
    if (kept_from_) traffic_ = {*kept_from_};
  }

  /// Who has blocked the road stands for ever, so that a way round is looked for; until it moves.
  void keep_parked(double t_s) {
    std::set<std::string> parked;
    for (std::size_t i = 0; i < task_.obstacles.size() && !parked_.empty(); ++i) {
      const Obstacle& one = task_.obstacles[i];
      if (!parked_.contains(one.id) || !is_standing(one, t_s)) continue;
      parked.insert(one.id);
      if (!kept_from_) kept_from_.emplace(task_.obstacles.begin(), task_.obstacles.end());
      stay(t_s, (*kept_from_)[i]);
    }
    parked_ = std::move(parked);
  }

  const Visibility* sight() const { return sight_ ? &*sight_ : nullptr; }

  Visibility sight_at(const PlannerView& view) const {
    std::vector<geometry::Rectangle> bodies;
    for (const BodyThere& there : bodies_there(task_.obstacles, view.t_s)) {
      bodies.push_back(there.body);
    }
    return {geometry::body_at(view.measured.map_from_vehicle, vehicle_), *task_.sight_m,
            std::move(bodies), task_.field, task_.road_map};
  }

  geometry::LinePosition place_on(const GoalLine& on, const PlannerView& view) const {
    return on.line.project(view.measured.map_from_vehicle.position(), replanner().s_m());
  }

  /// Who follows keeps its own distance; who crosses is a matter of the speed, not of the path.
  void tell_others_apart(PlanningScene& scene) {
    if (task_.goal) return;
    const PlannerView& view = scene.view;
    const geometry::LinePosition at = place_on(lines_.driven(), view);
    const VehicleOnLine vehicle{lines_.driven().line, at.s_m, at.d_m, vehicle_.width_m};
    for (const Obstacle& other : traffic_.obstacles) {
      scene.no_matter.push_back(
          !other.is_static() &&
          (is_following(other, view.t_s, vehicle) ||
           comes_behind(other, view.t_s, vehicle, view.measured.speed_mps, vehicle_)));
      scene.crosses.push_back(is_crossing(other, view.t_s, vehicle.line));
    }
  }

  PassingDecision passing_at(const PlannerView& view) {
    if (task_.goal) return {};
    const geometry::LinePosition at = place_on(lines_.first(), view);
    const ViewOnLine on_line{view.t_s, at, view.measured.speed_mps, traffic_, sight()};
    PassingDecision passing{.is_blocked = !parked_.empty()};
    passing.merging = merging_.look(on_line, replanner().s_m());
    if (passing.merging.along != Merging::Along::route_line) return passing;
    passing.letting_in = letting_in_.look(on_line);
    passing.overtaking = overtaking_.look(on_line);
    if (!passing.overtaking.overtaken && !passing.merging.is_near()) {
      passing.in_lane = lane_passing_.look(on_line);
    }
    if (!passing.merging.is_near()) passing.within_lane = within_lane(on_line, passing);
    return passing;
  }

  WithinLanePassing within_lane(const ViewOnLine& view, const PassingDecision& passing) {
    const GoalLine& on = lines_.driven();
    const LateralReplanner::Offsets offsets = offsets_in_lane(passing);
    return look_within_lane({.view = view,
                             .line = on.line,
                             .vehicle = vehicle_,
                             .free_mps = on.ceiling.at(view.at.s_m).speed_mps,
                             .clearance_m = clearance_m_,
                             .most_left_m = offsets.most_m,
                             .most_right_m = -offsets.least_m});
  }

  PlanningScene scene_at(const PlannerView& view, const PassingDecision& passing) {
    const Merging::Decision& merging = passing.merging;
    PlanningScene scene{.view = view,
                        .traffic = traffic_,
                        .last_command_mps2 = last_command_mps2_,
                        .most_mps = merging.most_mps};
    if (const std::optional<Lead>& behind = passing.letting_in.behind) {
      const double most_mps = approach_speed(*behind, {}, cruise_.options()).speed_mps;
      scene.most_mps = std::min(most_mps, scene.most_mps.value_or(most_mps));
    }
    tell_others_apart(scene);
    for (std::size_t i = 0; i < merging.comes_behind.size(); ++i) {
      if (merging.comes_behind[i]) scene.no_matter[i] = true;
    }
    scene.bodies =
        TrafficBodies(traffic_, view.t_s, speed_.steps(view.t_s), {scene.crosses, clearance_m_});
    if (task_.goal) return scene;
    if (task_.sight_m) scene.walkers = hidden_walkers(view);
    scene.halt =
        cruise_.look(view, place_on(lines_.first(), view).s_m, lines_.driven(), traffic_, sight());
    if (scene.halt &&
        &lines_.driven() != &lines_.first()) {  // as far ahead on the line that is driven
      scene.halt->s_m += replanner().s_m() - place_on(lines_.first(), view).s_m;
    }
    if (merging.halt && (!scene.halt || merging.halt->s_m < scene.halt->s_m)) {
      scene.halt = merging.halt;
    }
    return scene;
  }

  /// As far as the vehicle takes to stop comfortably, and a little more.
  std::vector<HiddenWalker> hidden_walkers(const PlannerView& view) const {
    constexpr double kMore_m = 10.0;
    const GoalLine& on = lines_.driven();
    const double speed_mps = view.measured.speed_mps;
    const double stopping_m = 0.5 * speed_mps * speed_mps / cruise_.options().deceleration_mps2;
    const PathProfile path = sample_path_profile(on.replanner.expected_path(), on.replanner.s_m(),
                                                 stopping_m + kMore_m, on.ceiling, vehicle_);
    return find_hidden_walkers({.path = path,
                                .line = on.line,
                                .vehicle = vehicle_,
                                .task = task_,
                                .traffic = traffic_,
                                .t_s = view.t_s});
  }

  /// For a path to a goal in time only what stands for a while, as something that stands for ever:
  /// what moves is a matter of the speed.
  std::vector<Obstacle> obstacles_to_plan_for(const PlanningScene& scene) const {
    const PlannerView& view = scene.view;
    std::vector<Obstacle> obstacles;
    for (std::size_t i = 0; i < traffic_.obstacles.size(); ++i) {
      const Obstacle& obstacle = traffic_.obstacles[i];
      if (!obstacle.is_there(view.t_s)) continue;
      if (!task_.goal) {
        if (scene.no_matter[i] || scene.crosses[i]) continue;
        obstacles.push_back(obstacle);
        continue;
      }
      const geometry::TrajectoryPoint now = obstacle.motion.at(view.t_s);
      const geometry::TrajectoryPoint later = obstacle.motion.at(view.t_s + kStillFor_s);
      if ((later.pose().position() - now.pose().position()).norm() > kStill_m) continue;
      obstacles.push_back(obstacle);
      stay(view.t_s, obstacles.back());
    }
    return obstacles;
  }

  static void stay(double t_s, Obstacle& obstacle) {
    obstacle.motion = geometry::Trajectory({obstacle.motion.at(t_s)});
  }

  LateralReplanner::Question question_at(const PlannerView& view,
                                         const std::vector<Obstacle>& obstacles) const {
    LateralReplanner::Question question{.t_s = view.t_s,
                                        .measured = view.measured,
                                        .speed = speed_plan(view.measured),
                                        .obstacles = obstacles,
                                        .explains = view.explains};
    const double speed_mps = view.measured.speed_mps;
    question.ends = task_.goal ? ends_before_goal(speed_mps) : ends_on_route(speed_mps);
    return question;
  }

  /// The last longitudinal plan as lateral planning understands it. Who stands is asked for a path
  /// to set off along: any is feasible at rest.
  SpeedPlan speed_plan(const VehicleState& measured) const {
    const double speed = measured.speed_mps;
    if (!task_.goal) {
      const bool stands = std::max(speed, last_set_speed_mps_) < kSettingOff_mps;
      if (stands) return {speed, kSettingOff_mps2, kSettingOff_mps};
      return {speed, measured.acceleration_mps2, last_set_speed_mps_};
    }
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

  // What becomes of the best.

  void take(const ManeuverHypothesis& best) {
    lines_.drive(*best.goal_line);
    lines_.driven().replanner.take(best.proposal);
    last_plan_ = best.answer.plan;
  }

  PlannerCommand by_cruise_law(const ManeuverHypothesis& best, const PlanningScene& scene,
                               const PassingDecision& passing) {
    return cruise_.command({.view = scene.view,
                            .on = lines_.driven(),
                            .traffic = traffic_,
                            .passing = passing,
                            .maneuver = best.maneuver,
                            .no_lead = who_crosses_in_time(best, scene),
                            .halt = scene.halt,
                            .walkers = scene.walkers});
  }

  /// Not those who are too near already.
  static std::vector<bool> who_crosses_in_time(const ManeuverHypothesis& best,
                                               const PlanningScene& scene) {
    if (!best.answer.is_free) return {};
    std::vector<bool> in_time = scene.crosses;
    for (const StInterval& part : best.occupancy->at(0)) {
      const bool touches = part.from_m < 0.0 && part.to_m > 0.0;
      if (touches && part.obstacle < in_time.size()) in_time[part.obstacle] = false;
    }
    return in_time;
  }

  /// To somebody whom the cruise law does not see coming.
  void give_way(const ManeuverHypothesis& best, PlannerCommand& command) const {
    const double searched_mps2 = first_command_mps2(best);
    if (searched_mps2 >= command.acceleration_mps2) return;
    command.acceleration_mps2 = searched_mps2;
    const bool is_emergency = !best.answer.is_free || best.risk_level->is_emergency;
    if (command.behaviour == Behaviour::emergency) return;
    command.behaviour = is_emergency ? Behaviour::emergency : Behaviour::yield;
    command.reason = "somebody comes into the way";
    if (!best.meeting || best.meeting->obstacle >= traffic_.obstacles.size()) return;
    const Obstacle& other = traffic_.obstacles[best.meeting->obstacle];
    command.reason =
        fmt::format("{} {} would be met in {:.1f} s{}", other.kind, other.id, best.meeting->after_s,
                    best.answer.is_free
                        ? ""
                        : fmt::format(", and {:.1f} s is free at best", best.answer.free_until_s));
  }

  void look_for_detour(const PlannerView& view, const Merging::Decision& merging,
                       PlannerCommand& command) {
    auto missed = missed_change_.look(
        {.t_s = view.t_s,
         .measured = view.measured,
         .no_gap = merging.no_gap,
         .limit_mps = lines_.driven().line.corridor_at(replanner().s_m()).speed_limit_mps});
    if (!missed) return look_at_blocked_road(view, command);
    command.reason = std::move(missed->reason);
    command.is_news = true;
    command.detour = std::move(missed->detour);
  }

  void look_at_blocked_road(const PlannerView& view, PlannerCommand& command) {
    std::optional<BlockedRoad::Decision> blocked =
        blocked_road_.look({.t_s = view.t_s,
                            .measured = view.measured,
                            .traffic = traffic_,
                            .ahead = who_is_in_the_way(view, command),
                            .waits_for_rule = command.behaviour == Behaviour::yield});
    if (!blocked) return;
    for (const std::size_t one : blocked->blockers) parked_.insert(traffic_.obstacles[one].id);
    command.behaviour = Behaviour::stop;
    command.reason = std::move(blocked->reason);
    command.is_news = blocked->is_news;
    command.detour = std::move(blocked->detour);
  }

  /// The lead; where no path keeps its clearance, who would be nearer than that on the path that is
  /// kept, or on the line.
  std::optional<std::size_t> who_is_in_the_way(const PlannerView& view,
                                               const PlannerCommand& command) const {
    if (command.lead) {
      const auto lead = std::ranges::find(task_.obstacles, command.lead->id, &Obstacle::id);
      return static_cast<std::size_t>(lead - task_.obstacles.begin());
    }
    if (replanner().last_plan().chosen) return std::nullopt;
    const PlannedPath line(lines_.driven().line,
                           [](double s_m) { return LateralState{.s_m = s_m}; });
    for (const PlannedPath& path : {replanner().expected_path(), line}) {
      const auto nearest = find_lead(path, replanner().s_m(), PlanOptions{}.max_l_m,
                                     traffic_.obstacles, view.t_s, vehicle_, clearance_m_);
      if (nearest) return nearest->obstacle;
    }
    return std::nullopt;
  }

  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  double clearance_m_;
  std::optional<std::vector<Obstacle>> kept_from_;  ///< wider, or parked; none: as they are
  Traffic traffic_;                                 ///< those
  std::optional<Visibility> sight_;                 ///< none: nothing is hidden
  GoalLines lines_;
  CruiseLaw cruise_;
  Overtaking overtaking_;
  LanePassing lane_passing_;
  Merging merging_;
  LettingIn letting_in_;
  HypothesisSpeed speed_;
  Hypotheses hypotheses_;
  BlockedRoad blocked_road_;
  MissedLaneChange missed_change_;
  CommandGuard guard_;
  CommandHold hold_;
  std::set<std::string> parked_;  ///< ids of those who have blocked the road
  double last_command_mps2_ = 0.0, last_set_speed_mps_ = 0.0;
  std::vector<SpeedState> last_plan_;
};

Planner::Planner(const PlannerSetup& setup) : impl_(std::make_unique<Impl>(setup)) {}
Planner::~Planner() = default;
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;

PlannerCommand Planner::decide(const PlannerView& view) { return impl_->decide(view); }

const LateralReplanner& Planner::replanner() const { return impl_->replanner(); }

}  // namespace roadbed::planning::behaviour
