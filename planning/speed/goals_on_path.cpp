#include "roadbed/planning/speed/goals_on_path.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace roadbed::planning::inline speed {
namespace {

constexpr double kInside_m = 0.25, kInsideAlong_m = 0.3, kInside_rad = 0.05, kInside_mps = 0.2;
constexpr double kMostOfWindow = 0.25;  // on each side
constexpr double kExactEdge_m = 0.01;
constexpr double kLaterPath_m = 60.0;

/// A window without a margin on both sides.
Window inside(const Window& window, double margin) {
  const double width = window.most - window.least;
  const double kept = std::isfinite(width) ? std::min(margin, kMostOfWindow * width) : margin;
  return {window.least + kept, window.most - kept};
}

/// The vehicle on its way, anywhere between two samples.
class BodyOnPath {
 public:
  BodyOnPath(const GoalState& state, const map::RoadMap& road_map, const PathProfile& profile)
      : state_(state), road_map_(road_map), profile_(profile) {
    if (state.heading_rad) heading_rad_ = inside(*state.heading_rad, kInside_rad);
  }

  /// Whether the goal's place and heading are met there, by so much to both sides.
  bool meets(double ahead_m, bool with_margin) const {
    const std::size_t i = std::min(profile_.before(ahead_m), profile_.ahead_m.size() - 2);
    const double step_m = profile_.ahead_m[i + 1] - profile_.ahead_m[i];
    const double part = step_m > 0.0 ? (ahead_m - profile_.ahead_m[i]) / step_m : 0.0;
    const geometry::Rectangle &a = profile_.body[i], &b = profile_.body[i + 1];
    const Eigen::Vector2d centre = a.centre + part * (b.centre - a.centre);
    const Eigen::Vector2d axis = (a.axis + part * (b.axis - a.axis)).normalized();
    const double heading_rad = std::atan2(axis.y(), axis.x());
    const auto& window = with_margin ? heading_rad_ : state_.heading_rad;
    if (window && !holds_heading(*window, heading_rad)) return false;
    if (!with_margin) return is_at_place(state_, road_map_, centre);
    const Eigen::Vector2d aside = kInside_m * Eigen::Vector2d(-axis.y(), axis.x());
    return is_at_place(state_, road_map_, centre + aside) &&
           is_at_place(state_, road_map_, centre - aside);
  }

  /// All stretches of the path on which it is met.
  std::vector<Window> stretches(bool with_margin) const {
    std::vector<Window> found;
    bool was_in = false;
    for (std::size_t i = 0; i < profile_.ahead_m.size(); ++i) {
      const double here_m = profile_.ahead_m[i];
      const bool is_in = meets(here_m, with_margin);
      const double before_m = i > 0 ? profile_.ahead_m[i - 1] : here_m;
      if (is_in && !was_in) found.push_back({edge_m(here_m, before_m, with_margin), here_m});
      if (is_in) found.back().most = here_m;
      if (!is_in && was_in) found.back().most = edge_m(before_m, here_m, with_margin);
      was_in = is_in;
    }
    return found;
  }

 private:
  /// Between a place that meets it and one that does not.
  double edge_m(double in_m, double out_m, bool with_margin) const {
    if (in_m == out_m) return in_m;
    while (std::abs(out_m - in_m) > kExactEdge_m) {
      const double middle_m = 0.5 * (in_m + out_m);
      (meets(middle_m, with_margin) ? in_m : out_m) = middle_m;
    }
    return in_m;
  }

  const GoalState& state_;
  const map::RoadMap& road_map_;
  const PathProfile& profile_;
  std::optional<Window> heading_rad_;  ///< with a margin
};

std::vector<Window> stretches_of(const GoalState& state, const map::RoadMap& road_map,
                                 const PathProfile& profile) {
  if (state.is_anywhere() && !state.heading_rad) return {Window{}};
  const BodyOnPath body(state, road_map, profile);
  std::vector<Window> found = body.stretches(true);
  return found.empty() ? body.stretches(false) : found;
}

GoalAhead goal_ahead(const TimedGoal& goal, const Window& time_s, const Window& speed_mps,
                     const Window& ahead_m, double now_s) {
  return {.time_s = {time_s.least - now_s, time_s.most - now_s},
          .speed_mps = inside(speed_mps, kInside_mps),
          .ahead_m = inside(ahead_m, kInsideAlong_m),
          .step_s = goal.step_s,
          .a_step_s = -now_s};
}

}  // namespace

std::vector<GoalAhead> goals_on_path(const TimedGoal& goal, const map::RoadMap& road_map,
                                     const PathProfile& profile, double now_s) {
  std::vector<GoalAhead> ahead;
  if (profile.ahead_m.size() < 2) return ahead;
  for (const GoalState& state : goal.states) {
    for (const Window& stretch : stretches_of(state, road_map, profile)) {
      ahead.push_back(goal_ahead(goal, state.time_s, state.speed_mps, stretch, now_s));
    }
  }
  return ahead;
}

PathGoals path_goals(const TimedGoal& goal, const map::RoadMap& road_map,
                     const std::vector<GoalStretch>& stretches, const PathProfile& profile,
                     double now_s) {
  PathGoals found{.goals = goals_on_path(goal, road_map, profile, now_s)};
  if (!found.goals.empty()) return found;
  found.is_off_path = true;
  for (const GoalStretch& stretch : stretches) {
    const Window ahead_m{profile.ahead_of_m(stretch.s_m.least),
                         profile.ahead_of_m(stretch.s_m.most)};
    found.is_off_path = found.is_off_path && !(ahead_m.least >= kLaterPath_m);
    found.goals.push_back(goal_ahead(goal, stretch.time_s, stretch.speed_mps, ahead_m, now_s));
  }
  return found;
}

}  // namespace roadbed::planning::speed
