#include "roadbed/planning/speed/goal_reach.h"

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline speed {
namespace {

constexpr double kStep_s = StGraph::kStep_s;
constexpr double kBeyondHorizon_s = 1.0;  // a search looks to the end of the layer it ends in

/// Places along the path at which a drive may be at one time.
using Places = std::vector<Window>;

/// What is left of them beside what is blocked, whose parts are open at their ends.
Places unblocked(const Places& places, const std::vector<StInterval>& parts) {
  Places left = places;
  for (const StInterval& part : parts) {
    Places next;
    for (const Window& place : left) {
      if (place.least <= part.from_m) {
        next.push_back({place.least, std::min(place.most, part.from_m)});
      }
      if (place.most >= part.to_m) next.push_back({std::max(place.least, part.to_m), place.most});
    }
    left = std::move(next);
  }
  return left;
}

/// After driving on for a step, or standing; those that overlap become one.
Places driven_on(const Places& places, double most_mps, double end_m) {
  Places next;
  for (const Window& place : places) {
    const double most_m = std::min(end_m, place.most + most_mps * kStep_s);
    if (!next.empty() && place.least <= next.back().most) {
      next.back().most = std::max(next.back().most, most_m);
    } else {
      next.push_back({place.least, most_m});
    }
  }
  return next;
}

/// A goal's moment may lie a step before or behind, and is met a step of driving away.
bool meets(const GoalAhead& goal, const Places& places, double t_s, double most_mps) {
  if (t_s < goal.time_s.least - kStep_s || t_s > goal.time_s.most + kStep_s) return false;
  const double slack_m = most_mps * kStep_s;
  return std::ranges::any_of(places, [&](const Window& place) {
    return place.least <= goal.ahead_m.most + slack_m && place.most >= goal.ahead_m.least - slack_m;
  });
}

}  // namespace

bool may_reach_goal(const SpeedSearchQuestion& question, double most_mps2) {
  if (question.goal_is_off_path || question.goals.empty()) return true;
  const double fastest_mps2 = std::max(most_mps2, question.acceleration_mps2);
  const auto steps = static_cast<int>(std::ceil((question.horizon_s + kBeyondHorizon_s) / kStep_s));
  Places places{{0.0, 0.0}};
  for (int step = 1; step <= steps && !places.empty(); ++step) {
    const double t_s = kStep_s * step, most_mps = question.speed_mps + fastest_mps2 * t_s;
    places = unblocked(driven_on(places, most_mps, question.end_m), question.occupancy.at(step));
    std::ranges::sort(places, {}, &Window::least);
    for (const GoalAhead& goal : question.goals) {
      if (meets(goal, places, t_s, most_mps)) return true;
    }
  }
  return false;
}

}  // namespace roadbed::planning::speed
