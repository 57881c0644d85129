#include "roadbed/planning/behaviour/hypotheses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "roadbed/planning/behaviour/why_lost.h"
#include "roadbed/planning/speed/drive_search.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kSearchEvery_s = 0.2;  // for a drive, while nothing else is any good
constexpr SpeedSearchOptions kHardest{.least_mps2 = -geometry::kLongitudinal.max_braking_mps2,
                                      .most_mps2 = 4.0};
constexpr BendLimits kFastBends{.max_lateral_acceleration_mps2 = 3.8};  // of 3.9 that are steered

/// From the most careful on; for those who have to be at their goal in time, and for those who
/// have not, to whom only those in their way matter.
constexpr std::array<RiskLevel, 3> kInTime{
    {{.margin_m = 0.4, .speed = {}, .is_emergency = false},
     {.margin_m = 0.4, .speed = kHardest, .is_emergency = true, .bends = kFastBends},
     {.margin_m = 0.1, .speed = kHardest, .is_emergency = true, .bends = kFastBends}}};
constexpr std::array<RiskLevel, 2> kOnRoute{
    {{.margin_m = 0.1, .speed = {}, .is_emergency = false},
     {.margin_m = 0.1,
      .speed = {.least_mps2 = -geometry::kLongitudinal.max_braking_mps2},
      .is_emergency = true}}};

/// Where nothing within the usual limits reaches the goal in time: those of tyres on a dry road.
/// What is searched for leaves room for the path through it, and that for the wheels to keep to it.
constexpr RiskLevel kAtTyreLimit{.margin_m = 0.1,
                                 .speed = kHardest,
                                 .is_emergency = true,
                                 .bends = {.max_lateral_acceleration_mps2 = 9.0},
                                 .most_lateral_mps2 = 10.0};
constexpr DriveSearchOptions kSearchAtTyreLimit{.max_lateral_acceleration_mps2 = 8.0};
constexpr double kUsualLimitsFor_s = 0.2;  // of searching in vain

double ends_beside_m(const LateralReplanner::Proposal& proposal) {
  return std::abs(proposal.plan.chosen->end_d_m);
}

}  // namespace

ManeuverHypothesis Hypotheses::best(const PlanningScene& scene,
                                    const LateralReplanner::Question& question,
                                    const PassingDecision& passing) {
  all_.clear();
  best_ = 0;
  outcomes_ = not_asked_for(passing);
  add(scene, first_queries(lines_.driven(), question, passing));
  if (task_.goal && !is_good(best_of_all())) {
    if (auto kept =
            lines_.driven().replanner.kept_drive(scene.view.t_s, scene.view.measured.speed_mps)) {
      add_drive(scene, question, lines_.driven(), std::move(*kept));
    }
  }
  const bool is_too_near =
      !best_of_all().answer.is_free && best_of_all().occupancy->is_blocked(0, 0.0);
  if (task_.goal && is_too_near) search_at_levels(scene);  // as it is on any path
  if (task_.goal && !is_good(best_of_all())) add_others(scene, question);
  search_at_levels(scene);
  if (task_.goal && !is_good(best_of_all())) find_drive(scene, question);
  std::ranges::move(outcomes_of(all_, best_, scene.traffic), std::back_inserter(outcomes_));
  return std::move(best_of_all());
}

/// In place and time at once, as the last resort; along the line that it keeps nearest to.
void Hypotheses::find_drive(const PlanningScene& scene,
                            const LateralReplanner::Question& question) {
  const double t_s = scene.view.t_s;
  if (t_s < next_search_s_) return;
  next_search_s_ = t_s + kSearchEvery_s;
  const bool at_tyre_limit = vain_since_s_ && t_s - *vain_since_s_ >= kUsualLimitsFor_s;
  const DriveSearchOptions options = at_tyre_limit ? kSearchAtTyreLimit : DriveSearchOptions{};
  if (task_.goal->latest_s().value_or(t_s) - t_s > options.longest_s) return;  // not yet in vain
  const std::vector<VehicleState> drive = search_drive({.vehicle = vehicle_,
                                                        .road_map = task_.road_map,
                                                        .bodies = scene.bodies,
                                                        .goal = *task_.goal,
                                                        .start = scene.view.measured,
                                                        .now_s = t_s},
                                                       options);
  if (drive.empty()) {
    const SpeedSearchAnswer& otherwise = best_of_all().answer;
    const bool is_vain = otherwise.misses_goal || !otherwise.is_free;
    if (is_vain && !vain_since_s_) vain_since_s_ = t_s;
    return;
  }
  drives_at_tyre_limit_ = at_tyre_limit;
  if (!at_tyre_limit) vain_since_s_.reset();
  GoalLine* nearest = nullptr;
  std::optional<LateralReplanner::Proposal> along;
  for (GoalLine& line : lines_.all()) {
    if (&line != &lines_.driven()) line.replanner.locate(scene.view.measured);
    auto found = line.replanner.through(drive, scene.view.t_s);
    if (!found || (along && ends_beside_m(*found) >= ends_beside_m(*along))) continue;
    nearest = &line;
    along = std::move(found);
  }
  if (nearest) add_drive(scene, question, *nearest, std::move(*along));
}

/// Searched for its speed at the levels from which such a path is driven.
void Hypotheses::add_drive(const PlanningScene& scene, const LateralReplanner::Question& question,
                           GoalLine& on, LateralReplanner::Proposal proposal) {
  on.replanner.explain_by_candidates(question, proposal);
  all_.push_back(hypothesis_on(scene, on, Maneuver::beside, std::move(proposal)));
  for (const RiskLevel& level : kInTime) {
    if (!level.is_emergency || is_good(all_.back())) continue;
    speed_.search(scene, level, all_.back());
  }
  if (drives_at_tyre_limit_ && !is_good(all_.back())) {
    speed_.search(scene, kAtTyreLimit, all_.back());
  }
  if (is_better(all_.back(), best_of_all())) best_ = all_.size() - 1;
}

/// One that is drivable is searched again only if some speed could reach its goal.
void Hypotheses::search_at_levels(const PlanningScene& scene) {
  const std::span<const RiskLevel> levels =
      task_.goal ? std::span<const RiskLevel>(kInTime) : std::span<const RiskLevel>(kOnRoute);
  for (const RiskLevel& level : levels) {
    for (std::size_t i = 0; i < all_.size() && !is_good(best_of_all()); ++i) {
      if (all_[i].risk_level == &level) continue;
      if (is_drivable(all_[i]) && !speed_.may_reach_goal(scene, level, all_[i])) continue;
      speed_.search(scene, level, all_[i]);
      if (is_better(all_[i], best_of_all())) best_ = i;
    }
  }
}

std::vector<PathQuery> Hypotheses::first_queries(GoalLine& on,
                                                 const LateralReplanner::Question& question,
                                                 const PassingDecision& passing) const {
  return task_.goal ? queries_to_goal(on, question) : queries_on_route(on, question, passing);
}

/// Those for which there is a path, until one is good; the last one of the first line always.
void Hypotheses::add(const PlanningScene& scene, const std::vector<PathQuery>& queries) {
  for (const PathQuery& query : queries) {
    if (!all_.empty() && is_good(best_of_all())) return;
    ManeuverHypothesis found = hypothesis_of(scene, query);
    const bool is_needed = all_.empty() && &query == &queries.back();
    if (!found.has_candidate() && !is_needed) {
      outcomes_.push_back(without_path(found));
      continue;
    }
    set_first_speed(scene, found);
    all_.push_back(std::move(found));
    if (is_better(all_.back(), best_of_all())) best_ = all_.size() - 1;
  }
}

void Hypotheses::add_others(const PlanningScene& scene,
                            const LateralReplanner::Question& question) {
  GoalLine& on = lines_.driven();
  if (!is_drivable(best_of_all())) add(scene, queries_beside(on, question));
  if (best_of_all().answer.misses_goal) {
    add(scene, queries_in_other_lanes(on, question));
  }
  std::vector<const GoalLine*> tried{&on};
  for (GoalLine& other : lines_.all()) {
    if (&other == &on || is_good(best_of_all())) continue;
    other.replanner.locate(scene.view.measured);
    const double ahead_m = speed_.look_ahead_m(scene.view);
    const auto is_like = [&](const GoalLine* one) { return run_alike(*one, other, ahead_m); };
    if (std::ranges::any_of(tried, is_like)) continue;
    add(scene, first_queries(other, question));
    tried.push_back(&other);
  }
}

ManeuverHypothesis Hypotheses::hypothesis_of(const PlanningScene& scene, const PathQuery& query) {
  GoalLine& on = *query.goal_line;
  LateralReplanner::Proposal proposal =
      on.replanner.propose(query.question, query.offsets, query.may_leave_lanes);
  if (!proposal.plan.chosen && query.bounds_kept_path) {
    proposal.checked_m = on.replanner.kept_within_m(query.offsets);
  }
  return hypothesis_on(scene, on, query.maneuver, std::move(proposal));
}

ManeuverHypothesis Hypotheses::hypothesis_on(const PlanningScene& scene, GoalLine& on,
                                             Maneuver maneuver,
                                             LateralReplanner::Proposal proposal) {
  const bool leads_back = !task_.goal && maneuver == Maneuver::keep_lane;
  const PlannedPath path =
      leads_back ? on.replanner.expected_path_of(proposal) : on.replanner.path_of(proposal);
  PathProfile profile = sample_path_profile(path, on.replanner.s_m(),
                                            speed_.look_ahead_m(scene.view), on.ceiling, vehicle_);
  const bool may_leave_road =
      task_.goal && (!proposal.plan.chosen || proposal.knots || proposal.beyond_the_edge_m > 0.0);
  const double on_road =
      may_leave_road ? on_road_m(profile, task_.road_map) : std::numeric_limits<double>::infinity();
  return {.goal_line = &on,
          .maneuver = maneuver,
          .proposal = std::move(proposal),
          .profile = std::move(profile),
          .on_road_m = on_road};
}

/// Overtaking has been judged in space and time before it was begun.
void Hypotheses::set_first_speed(const PlanningScene& scene, ManeuverHypothesis& hypothesis) const {
  if (task_.goal) {
    speed_.search(scene, kInTime.front(), hypothesis);
    return;
  }
  speed_.forecast(scene, hypothesis);
  if (hypothesis.maneuver == Maneuver::overtake) hypothesis.answer.is_free = true;
}

}  // namespace roadbed::planning::behaviour
