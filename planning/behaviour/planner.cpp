#include "roadbed/planning/behaviour/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "roadbed/planning/behaviour/blocked_road.h"
#include "roadbed/planning/behaviour/cruise_law.h"
#include "roadbed/planning/behaviour/hypothesis_speed.h"
#include "roadbed/planning/behaviour/lane_passing.h"
#include "roadbed/planning/behaviour/lead.h"
#include "roadbed/planning/behaviour/maneuver_hypothesis.h"
#include "roadbed/planning/behaviour/merging.h"
#include "roadbed/planning/behaviour/overtaking.h"
#include "roadbed/planning/behaviour/path_queries.h"
#include "roadbed/planning/behaviour/why_lost.h"
#include "roadbed/planning/obstacles/traffic.h"
#include "roadbed/planning/reference/road_end.h"
#include "roadbed/planning/speed/drive_search.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kSearchEvery_s = 0.2;               // for a drive, while nothing else is any good
constexpr double kStillFor_s = 3.0, kStill_m = 0.5;  // what counts as standing
constexpr double kLookForPath_s = 3.0;               // the speed plan that lateral planning is told
constexpr double kCompareEvery_m = 4.0, kAlike_m = 0.1;  // of two lines
constexpr SpeedSearchOptions kHardest{.least_mps2 = -8.0, .most_mps2 = 4.0};
constexpr BendLimits kFastBends{.max_lateral_acceleration_mps2 = 3.8};  // of 3.9 that are steered

/// From the most careful on; for those who have to be at their goal in time, and for those who
/// have not, to whom only those in their way matter.
constexpr std::array<RiskLevel, 3> kInTime{
    {{.margin_m = 0.4, .speed = {}, .is_emergency = false},
     {.margin_m = 0.4, .speed = kHardest, .is_emergency = true, .bends = kFastBends},
     {.margin_m = 0.1, .speed = kHardest, .is_emergency = true, .bends = kFastBends}}};
constexpr std::array<RiskLevel, 2> kOnRoute{
    {{.margin_m = 0.1, .speed = {}, .is_emergency = false},
     {.margin_m = 0.1, .speed = {.least_mps2 = -8.0}, .is_emergency = true}}};

LateralReplanner::Bounds replanner_bounds(const PlannerSetup& setup) {
  LateralReplanner::Bounds bounds{.tracking_error_m = setup.planner.max_tracking_error_m,
                                  .heading_error_rad = setup.planner.max_heading_error_rad,
                                  .margin_levels = {},
                                  .keeps_candidates = setup.planner.keeps_candidates,
                                  .weights = setup.driving.weights};
  if (setup.task.goal) {
    bounds.margin_levels = {{0.2, 0.3}, {0.05, 0.12}, {-0.05, 0.2}, {-0.15, 0.2}, {-0.6, 0.12}};
    bounds.squeezes_past = true;
  } else {
    // In the sharpest turns of real maps no body keeps to its lane; the road is wider there.
    const double clearance_m = setup.driving.clearance_m;
    bounds.margin_levels = {{0.0, clearance_m}, {-0.3, clearance_m}, {-0.6, clearance_m}};
  }
  return bounds;
}

GoalLine goal_line_on(const ReferenceLine& line, std::vector<StopPoint> lights,
                      const PlannerSetup& setup) {
  const DrivingTask& task = setup.task;
  std::erase_if(lights, [](const auto& place) { return place.kind != StopKind::light; });
  return {.line = line,
          .road_end_s_m = road_end_s_m(line, task.road_map),
          .ceiling = ceiling_of(line, setup.vehicle, setup.driving),
          .stretches = task.goal ? goal_stretches(*task.goal, task.road_map, line, setup.vehicle)
                                 : std::vector<GoalStretch>{},
          .lights = task.goal ? std::move(lights) : std::vector<StopPoint>{},
          .replanner = {setup.vehicle, task, line, replanner_bounds(setup)}};
}

std::vector<GoalLine> goal_lines_of(const PlannerSetup& setup) {
  const DrivingTask& task = setup.task;
  std::vector<GoalLine> lines;
  lines.push_back(goal_line_on(task.line, task.stop_points, setup));
  for (std::size_t i = 0; i < task.other_lines.size(); ++i) {
    const bool has_places = i < task.other_stop_points.size();
    lines.push_back(goal_line_on(task.other_lines[i],
                                 has_places ? task.other_stop_points[i] : std::vector<StopPoint>{},
                                 setup));
  }
  return lines;
}

/// Whether two lines, and the room beside them, are the same from the vehicle on.
bool run_alike(const GoalLine& a, const GoalLine& b, double ahead_m) {
  for (double l_m = 0.0; l_m <= ahead_m; l_m += kCompareEvery_m) {
    const double in_a_m = a.replanner.s_m() + l_m, in_b_m = b.replanner.s_m() + l_m;
    if ((a.line.at(in_a_m).in_map - b.line.at(in_b_m).in_map).norm() > kAlike_m) return false;
    const Corridor of_a = a.line.corridor_at(in_a_m), of_b = b.line.corridor_at(in_b_m);
    if (std::abs(of_a.left_m - of_b.left_m) > kAlike_m ||
        std::abs(of_a.right_m - of_b.right_m) > kAlike_m)
      return false;
  }
  return true;
}

/// The slower, the nearer: a bend of a few metres wants paths that are no longer.
LateralReplanner::Ends ends_at(double speed_mps) {
  const double least_m = std::clamp(2.0 * speed_mps, 7.0, PlanOptions{}.min_l_m);
  return {.least_m = least_m, .most_m = 2.0 * least_m};
}

}  // namespace

class Planner::Impl {
 public:
  explicit Impl(const PlannerSetup& setup)
      : setup_(setup),
        vehicle_(setup.vehicle),
        task_(setup.task),
        predicts_(setup.planner.predicts),
        clearance_m_(setup.driving.clearance_m),
        goal_lines_(goal_lines_of(setup)),
        cruise_(setup),
        overtaking_(vehicle_, task_, goal_lines_.front().ceiling),
        lane_passing_(vehicle_, task_, goal_lines_.front().ceiling),
        merging_(vehicle_, task_, goal_lines_.front().ceiling),
        speed_(setup, cruise_.options()),
        blocked_road_(vehicle_, setup.driving, task_) {}

  const LateralReplanner& replanner() const { return current_->replanner; }

  PlannerCommand decide(const PlannerView& view) {
    foresee(view);
    goal_line().replanner.locate(view.measured);
    const PassingDecision passing = passing_at(view);
    drive_along(passing.merging.along, view);
    const PlanningScene scene = scene_at(view, passing.merging);
    const std::vector<Obstacle> obstacles = obstacles_to_plan_for(scene);
    const ManeuverHypothesis best = best_hypothesis(scene, question_at(view, obstacles), passing);
    take(best);
    PlannerCommand command =
        task_.goal ? speed_.command_of(best, scene) : cruised(best, scene, passing);
    command.hypotheses = std::move(outcomes_);
    if (!task_.goal) look_at_blocked_road(view, command);
    view.speed_controller.sent(command.acceleration_mps2);
    last_command_mps2_ = command.acceleration_mps2;
    last_set_speed_mps_ = command.set_speed_mps;
    return command;
  }

 private:
  GoalLine& goal_line() { return *current_; }
  GoalLine& first_line() { return goal_lines_.front(); }

  /// From here on, as merging asks.
  void drive_along(Merging::Along along, const PlannerView& view) {
    if (task_.goal) return;
    const std::shared_ptr<const MergeLines>& lines = merging_.lines();
    if (merge_lines_ && merge_lines_->lines != lines) {
      change_to(first_line(), view);
      merge_lines_.reset();
    }
    if (lines && !merge_lines_) {
      merge_lines_.emplace(LinesToMerge{lines, goal_line_on(lines->own_lane, {}, setup_),
                                        goal_line_on(lines->next_lane, {}, setup_)});
    }
    if (along == Merging::Along::route_line) change_to(first_line(), view);
    if (along == Merging::Along::own_lane) change_to(merge_lines_->own_lane, view);
    if (along == Merging::Along::next_lane) change_to(merge_lines_->next_lane, view);
  }

  void change_to(GoalLine& on, const PlannerView& view) {
    if (&on == current_) return;
    on.replanner.take_over(current_->replanner);
    on.replanner.locate(view.measured);
    current_ = &on;
  }

  // What will be where.

  void foresee(const PlannerView& view) {
    truth_ = Traffic{task_.obstacles};
    if (!task_.goal) {
      kept_from_ = with_room_beside_cyclists(
          truth_.obstacles, view.t_s, geometry::body_at(view.measured.map_from_vehicle, vehicle_),
          clearance_m_);
      if (kept_from_) truth_ = {*kept_from_};
    }
    traffic_ = truth_;
    if (!predicts_) return;
    predicted_.emplace(truth_, view.t_s);
    traffic_ = predicted_->traffic();
  }

  geometry::LinePosition place_on(const GoalLine& on, const PlannerView& view) const {
    return on.line.project(view.measured.map_from_vehicle.position(), current_->replanner.s_m());
  }

  /// Who follows keeps its own distance; who crosses is a matter of the speed, not of the path.
  void tell_others_apart(PlanningScene& scene) {
    if (task_.goal) return;
    const PlannerView& view = scene.view;
    const geometry::LinePosition at = place_on(goal_line(), view);
    const VehicleOnLine vehicle{goal_line().line, at.s_m, at.d_m, vehicle_.width_m};
    for (const Obstacle& other : traffic_.obstacles) {
      scene.no_matter.push_back(!other.is_static() && is_following(other, view.t_s, vehicle));
      scene.crosses.push_back(is_crossing(other, view.t_s, vehicle.line));
    }
  }

  PassingDecision passing_at(const PlannerView& view) {
    if (task_.goal) return {};
    const geometry::LinePosition at = place_on(first_line(), view);
    const ViewOnLine on_line{view.t_s, at, view.measured.speed_mps, traffic_};
    PassingDecision passing;
    passing.merging = merging_.look(on_line, replanner().s_m());
    if (passing.merging.along != Merging::Along::route_line) return passing;
    passing.overtaking = overtaking_.look(on_line);
    if (!passing.overtaking.overtaken && !passing.merging.is_near()) {
      passing.in_lane = lane_passing_.look(on_line);
    }
    if (!passing.merging.is_near()) passing.within_lane = within_lane(on_line, passing);
    return passing;
  }

  WithinLanePassing within_lane(const ViewOnLine& view, const PassingDecision& passing) {
    const GoalLine& on = goal_line();
    const LateralReplanner::Offsets offsets = offsets_in_lane(passing);
    return look_within_lane({.view = view,
                             .line = on.line,
                             .vehicle = vehicle_,
                             .free_mps = on.ceiling.at(view.at.s_m).speed_mps,
                             .clearance_m = clearance_m_,
                             .most_left_m = offsets.most_m,
                             .most_right_m = -offsets.least_m});
  }

  PlanningScene scene_at(const PlannerView& view, const Merging::Decision& merging) {
    PlanningScene scene{.view = view,
                        .traffic = traffic_,
                        .last_command_mps2 = last_command_mps2_,
                        .most_mps = merging.most_mps};
    tell_others_apart(scene);
    for (std::size_t i = 0; i < merging.comes_behind.size(); ++i) {
      if (merging.comes_behind[i]) scene.no_matter[i] = true;
    }
    scene.bodies =
        TrafficBodies(traffic_, view.t_s, speed_.steps(view.t_s), {scene.crosses, clearance_m_});
    if (task_.goal) return scene;
    scene.halt = cruise_.look(view, place_on(first_line(), view).s_m, goal_line(), traffic_);
    if (scene.halt && current_ != &first_line()) {  // as far ahead on the line that is driven
      scene.halt->s_m += replanner().s_m() - place_on(first_line(), view).s_m;
    }
    if (merging.halt && (!scene.halt || merging.halt->s_m < scene.halt->s_m)) {
      scene.halt = merging.halt;
    }
    return scene;
  }

  /// For a path to a goal in time only what stands for a while, as something that stands for ever:
  /// what moves is a matter of the speed.
  std::vector<Obstacle> obstacles_to_plan_for(const PlanningScene& scene) const {
    const PlannerView& view = scene.view;
    std::vector<Obstacle> obstacles;
    for (std::size_t i = 0; i < traffic_.obstacles.size(); ++i) {
      const Obstacle& obstacle = traffic_.obstacles[i];
      if (!task_.goal) {
        if (scene.no_matter[i] || scene.crosses[i]) continue;
        obstacles.push_back(obstacle);
        continue;
      }
      if (!obstacle.is_there(view.t_s)) continue;
      const geometry::TrajectoryPoint now = obstacle.motion.at(view.t_s);
      const geometry::TrajectoryPoint later = obstacle.motion.at(view.t_s + kStillFor_s);
      if ((later.pose().position() - now.pose().position()).norm() > kStill_m) continue;
      obstacles.push_back(obstacle);
      obstacles.back().motion = geometry::Trajectory({now});
    }
    return obstacles;
  }

  // Hypotheses.

  LateralReplanner::Question question_at(const PlannerView& view,
                                         const std::vector<Obstacle>& obstacles) const {
    LateralReplanner::Question question{.t_s = view.t_s,
                                        .measured = view.measured,
                                        .speed = speed_plan(view.measured),
                                        .obstacles = obstacles,
                                        .explains = view.explains};
    if (task_.goal) question.ends = ends_at(view.measured.speed_mps);
    return question;
  }

  /// The last longitudinal plan as lateral planning understands it.
  SpeedPlan speed_plan(const VehicleState& measured) const {
    const double speed = measured.speed_mps;
    if (!task_.goal) return {speed, measured.acceleration_mps2, last_set_speed_mps_};
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

  /// The first that is good, of the most careful risk level that has one; else the best of all.
  ManeuverHypothesis best_hypothesis(const PlanningScene& scene,
                                     const LateralReplanner::Question& question,
                                     const PassingDecision& passing) {
    std::vector<ManeuverHypothesis> all;
    std::size_t best = 0;
    outcomes_ = not_asked_for(passing);
    add(scene, first_queries(goal_line(), question, passing), all, best);
    if (task_.goal && !is_good(all[best])) {
      if (auto kept = goal_line().replanner.kept_drive()) {
        add_drive(scene, goal_line(), std::move(*kept), all, best);
      }
    }
    const bool is_too_near = !all[best].answer.is_free && all[best].occupancy->is_blocked(0, 0.0);
    if (task_.goal && is_too_near) search_at_levels(scene, all, best);  // as it is on any path
    if (task_.goal && !is_good(all[best])) add_others(scene, question, all, best);
    search_at_levels(scene, all, best);
    if (task_.goal && !is_good(all[best])) find_drive(scene, all, best);
    std::ranges::move(outcomes_of(all, best, traffic_), std::back_inserter(outcomes_));
    return std::move(all[best]);
  }

  /// In place and time at once, as the last resort; along the line that it keeps nearest to.
  void find_drive(const PlanningScene& scene, std::vector<ManeuverHypothesis>& all,
                  std::size_t& best) {
    if (scene.view.t_s < next_search_s_) return;
    next_search_s_ = scene.view.t_s + kSearchEvery_s;
    const std::vector<VehicleState> drive = search_drive({.vehicle = vehicle_,
                                                          .road_map = task_.road_map,
                                                          .bodies = scene.bodies,
                                                          .goal = *task_.goal,
                                                          .start = scene.view.measured,
                                                          .now_s = scene.view.t_s});
    if (drive.empty()) return;
    GoalLine* nearest = nullptr;
    std::optional<LateralReplanner::Proposal> along;
    for (GoalLine& line : goal_lines_) {
      if (&line != &goal_line()) line.replanner.locate(scene.view.measured);
      auto found = line.replanner.through(drive);
      if (!found || (along && ends_beside_m(*found) >= ends_beside_m(*along))) continue;
      nearest = &line;
      along = std::move(found);
    }
    if (nearest) add_drive(scene, *nearest, std::move(*along), all, best);
  }

  static double ends_beside_m(const LateralReplanner::Proposal& proposal) {
    return std::abs(proposal.plan.chosen->end_d_m);
  }

  /// Searched for its speed at the levels from which such a path is driven.
  void add_drive(const PlanningScene& scene, GoalLine& on, LateralReplanner::Proposal proposal,
                 std::vector<ManeuverHypothesis>& all, std::size_t& best) {
    all.push_back(hypothesis_on(scene, on, Maneuver::beside, std::move(proposal)));
    for (const RiskLevel& level : kInTime) {
      if (!level.is_emergency || is_good(all.back())) continue;
      speed_.search(scene, level, all.back());
    }
    if (is_better(all.back(), all[best])) best = all.size() - 1;
  }

  /// One that is drivable is searched again only if some speed could reach its goal.
  void search_at_levels(const PlanningScene& scene, std::vector<ManeuverHypothesis>& all,
                        std::size_t& best) {
    const std::span<const RiskLevel> levels =
        task_.goal ? std::span<const RiskLevel>(kInTime) : std::span<const RiskLevel>(kOnRoute);
    for (const RiskLevel& level : levels) {
      for (std::size_t i = 0; i < all.size() && !is_good(all[best]); ++i) {
        if (all[i].risk_level == &level) continue;
        if (is_drivable(all[i]) && !speed_.may_reach_goal(scene, level, all[i])) continue;
        speed_.search(scene, level, all[i]);
        if (is_better(all[i], all[best])) best = i;
      }
    }
  }

  std::vector<PathQuery> first_queries(GoalLine& on, const LateralReplanner::Question& question,
                                       const PassingDecision& passing = {}) const {
    return task_.goal ? queries_to_goal(on, question) : queries_on_route(on, question, passing);
  }

  /// Those for which there is a path, until one is good; the last one of the first line always.
  void add(const PlanningScene& scene, const std::vector<PathQuery>& queries,
           std::vector<ManeuverHypothesis>& all, std::size_t& best) {
    for (const PathQuery& query : queries) {
      if (!all.empty() && is_good(all[best])) return;
      ManeuverHypothesis found = hypothesis_of(scene, query);
      const bool is_needed = all.empty() && &query == &queries.back();
      if (!found.has_candidate() && !is_needed) {
        outcomes_.push_back(without_path(found));
        continue;
      }
      set_first_speed(scene, found);
      all.push_back(std::move(found));
      if (is_better(all.back(), all[best])) best = all.size() - 1;
    }
  }

  void add_others(const PlanningScene& scene, const LateralReplanner::Question& question,
                  std::vector<ManeuverHypothesis>& all, std::size_t& best) {
    GoalLine& on = goal_line();
    if (!is_drivable(all[best])) add(scene, queries_beside(on, question), all, best);
    if (all[best].answer.misses_goal) {
      add(scene, queries_in_other_lanes(on, question), all, best);
    }
    std::vector<const GoalLine*> tried{&on};
    for (GoalLine& other : goal_lines_) {
      if (&other == &on || is_good(all[best])) continue;
      other.replanner.locate(scene.view.measured);
      const double ahead_m = speed_.look_ahead_m(scene.view);
      const auto is_like = [&](const GoalLine* one) { return run_alike(*one, other, ahead_m); };
      if (std::ranges::any_of(tried, is_like)) continue;
      add(scene, first_queries(other, question), all, best);
      tried.push_back(&other);
    }
  }

  ManeuverHypothesis hypothesis_of(const PlanningScene& scene, const PathQuery& query) {
    GoalLine& on = *query.goal_line;
    return hypothesis_on(
        scene, on, query.maneuver,
        on.replanner.propose(query.question, query.offsets, query.may_leave_lanes));
  }

  ManeuverHypothesis hypothesis_on(const PlanningScene& scene, GoalLine& on, Maneuver maneuver,
                                   LateralReplanner::Proposal proposal) {
    const bool leads_back = !task_.goal && maneuver == Maneuver::keep_lane;
    const PlannedPath path =
        leads_back ? on.replanner.expected_path_of(proposal) : on.replanner.path_of(proposal);
    PathProfile profile = sample_path_profile(
        path, on.replanner.s_m(), speed_.look_ahead_m(scene.view), on.ceiling, vehicle_);
    const bool may_leave_road =
        task_.goal && (!proposal.plan.chosen || proposal.knots || proposal.beyond_the_edge_m > 0.0);
    const double on_road = may_leave_road ? on_road_m(profile, task_.road_map)
                                          : std::numeric_limits<double>::infinity();
    return {.goal_line = &on,
            .maneuver = maneuver,
            .proposal = std::move(proposal),
            .profile = std::move(profile),
            .on_road_m = on_road};
  }

  /// Overtaking has been judged in space and time before it was begun, and without a candidate
  /// the vehicle stops on the path that it has.
  void set_first_speed(const PlanningScene& scene, ManeuverHypothesis& hypothesis) const {
    if (task_.goal) {
      speed_.search(scene, kInTime.front(), hypothesis);
      return;
    }
    speed_.forecast(scene, hypothesis);
    if (hypothesis.maneuver == Maneuver::overtake || !hypothesis.has_candidate()) {
      hypothesis.answer.is_free = true;
    }
  }

  // What becomes of the best.

  void take(const ManeuverHypothesis& best) {
    current_ = best.goal_line;
    goal_line().replanner.take(best.proposal);
    last_plan_ = best.answer.plan;
  }

  PlannerCommand cruised(const ManeuverHypothesis& best, const PlanningScene& scene,
                         const PassingDecision& passing) {
    PlannerCommand command = cruise_.command({.view = scene.view,
                                              .on = goal_line(),
                                              .truth = truth_,
                                              .traffic = traffic_,
                                              .passing = passing,
                                              .maneuver = best.maneuver,
                                              .no_lead = who_crosses_in_time(best, scene),
                                              .halt = scene.halt});
    if (!best.by_cruise_law) give_way(best, command);
    return command;
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

  void look_at_blocked_road(const PlannerView& view, PlannerCommand& command) {
    std::optional<BlockedRoad::Decision> blocked =
        blocked_road_.look({.t_s = view.t_s,
                            .measured = view.measured,
                            .traffic = truth_,
                            .ahead = who_is_in_the_way(view, command),
                            .waits_for_rule = command.behaviour == Behaviour::yield});
    if (!blocked) return;
    command.behaviour = Behaviour::stop;
    command.reason = std::move(blocked->reason);
    command.is_news = blocked->is_news;
    command.detour = std::move(blocked->detour);
  }

  /// The lead; where no path keeps its clearance, who would be nearer than that.
  std::optional<std::size_t> who_is_in_the_way(const PlannerView& view,
                                               const PlannerCommand& command) const {
    if (command.lead) {
      const auto lead = std::ranges::find(task_.obstacles, command.lead->id, &Obstacle::id);
      return static_cast<std::size_t>(lead - task_.obstacles.begin());
    }
    if (replanner().last_plan().chosen) return std::nullopt;
    const std::optional<Lead> nearest =
        find_lead(replanner().expected_path(), replanner().s_m(), PlanOptions{}.max_l_m,
                  truth_.obstacles, view.t_s, vehicle_, clearance_m_);
    return nearest ? std::optional(nearest->obstacle) : std::nullopt;
  }

  PlannerSetup setup_;
  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  bool predicts_;
  double clearance_m_;
  std::optional<PredictedTraffic> predicted_;
  std::optional<std::vector<Obstacle>> kept_from_;  ///< wider than they are; none: as they are
  Traffic truth_;                                   ///< with that room
  Traffic traffic_;                   ///< what is planned against: the true one, or as foreseen
  std::vector<GoalLine> goal_lines_;  ///< the task's line first
  GoalLine* current_ = &goal_lines_.front();  ///< that is driven
  CruiseLaw cruise_;
  Overtaking overtaking_;
  LanePassing lane_passing_;
  Merging merging_;
  struct LinesToMerge {
    std::shared_ptr<const MergeLines> lines;
    GoalLine own_lane, next_lane;
  };
  std::optional<LinesToMerge> merge_lines_;
  HypothesisSpeed speed_;
  BlockedRoad blocked_road_;
  double next_search_s_ = 0.0;
  double last_command_mps2_ = 0.0, last_set_speed_mps_ = 0.0;
  std::vector<SpeedState> last_plan_;
  std::vector<HypothesisOutcome> outcomes_;  ///< of this cycle
};

Planner::Planner(const PlannerSetup& setup) : impl_(std::make_unique<Impl>(setup)) {}
Planner::~Planner() = default;
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;

PlannerCommand Planner::decide(const PlannerView& view) { return impl_->decide(view); }

const LateralReplanner& Planner::replanner() const { return impl_->replanner(); }

}  // namespace roadbed::planning::behaviour
