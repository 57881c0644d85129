#include "roadbed/tools/simulation/common_road_routes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/planning/obstacles/lanes_ahead.h"
#include "roadbed/planning/obstacles/recorded_obstacles.h"
#include "roadbed/planning/route/match_place.h"
#include "roadbed/planning/route/router.h"

namespace roadbed::tools::inline simulation {
namespace {

using geometry::Pose2;
using map::LanePlace;
using planning::Route;
using planning::Sense;

constexpr double kUsualSpeed_mps = 50.0 / 3.6;
constexpr double kNothingAskedFor_s = 10.0;  // a drive without a goal
constexpr double kRoadAhead_m = 120.0;       // beyond what is driven, to brake on
constexpr double kAtGoal_m = 3.0;            // a region's middle may lie so far beside its lane
constexpr int kGrid = 5;                     // points across a region that lanes are looked for at
constexpr std::size_t kMostOthers = 4;

/// Lanes that the vehicle's centre may be on, the best match first, at the rear axle's station.
std::vector<LanePlace> start_places(const ProblemSource& source, const Pose2& start,
                                    const geometry::VehicleShape& vehicle) {
  const double ahead_m = 0.5 * vehicle.length_m - vehicle.rear_overhang_m;
  const Eigen::Vector2d centre = start * Eigen::Vector2d(ahead_m, 0.0);
  std::vector<LanePlace> places;
  for (const planning::PlaceCandidate& match :
       planning::match_place(source.road_map, centre, start.heading_rad)) {
    if (match.verdict != planning::MatchVerdict::chosen &&
        match.verdict != planning::MatchVerdict::possible) {
      continue;
    }
    if (match.sense == Sense::against) continue;
    LanePlace place = match.place;
    place.s_m = std::max(0.0, place.s_m - ahead_m);
    places.push_back(place);
  }
  if (places.empty()) {
    source.refuse("a start off the road, or against a lane's direction",
                  "a lane that a car may use there", "correct the initial state");
  }
  return places;
}

/// The last place of the path that is driven if no lane is chosen on purpose.
LanePlace straight_ahead(const map::RoadMap& road_map, const LanePlace& from, double length_m) {
  constexpr int kMostLanes = 1000;
  LanePlace at = from;
  for (int i = 0; i < kMostLanes; ++i) {
    const double left_m = road_map.lane(at.lane).length_m() - at.s_m;
    const std::optional<map::LaneId> next = planning::straightest(road_map, at.lane);
    if (left_m >= length_m || !next) {
      at.s_m += std::min(left_m, length_m);
      break;
    }
    length_m -= left_m;
    at = {.lane = *next, .s_m = 0.0};
  }
  return at;
}

/// How far the vehicle may come until a time, so that lane changes are made before.
double reach_m(double speed_mps, double limit_mps, double until_s) {
  return std::max(speed_mps, limit_mps) * std::max(0.0, until_s);
}

std::optional<double> middle_heading(const planning::GoalState& state) {
  if (!state.heading_rad) return std::nullopt;
  return 0.5 * (state.heading_rad->least + state.heading_rad->most);
}

/// Places of a goal state that a route may lead to.
std::vector<LanePlace> goal_places(const ProblemSource& source, const planning::GoalState& state) {
  std::vector<LanePlace> places;
  for (const map::LaneId lane : state.lanes) {
    places.push_back({.lane = lane, .s_m = source.road_map.lane(lane).length_m()});
  }
  if (!state.region_in_source.empty()) {
    const Eigen::Vector2d middle =
        source.road_map.to_map(planning::middle_of(state.region_in_source));
    for (const auto& match : planning::match_place(source.road_map, middle, middle_heading(state),
                                                   {.reach_m = kAtGoal_m})) {
      if (match.verdict == planning::MatchVerdict::chosen) places.push_back(match.place);
    }
  }
  return places;
}

/// A place on each lane under a region that runs as the goal's heading asks, the nearest to its
/// middle.
std::vector<LanePlace> places_under(const ProblemSource& source, const planning::GoalState& state) {
  std::vector<std::pair<double, LanePlace>> nearest;
  const Eigen::AlignedBox2d box = planning::bounds_of(state.region_in_source);
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const Eigen::Array2d part(i % kGrid, i / kGrid);
    const Eigen::Vector2d point =
        box.min().array() + box.sizes().array() * (part + 0.5) / static_cast<double>(kGrid);
    if (!planning::contains(state.region_in_source, point)) continue;
    const double off_m = (point - box.center()).norm();
    for (const auto& match : planning::match_place(source.road_map, source.road_map.to_map(point),
                                                   middle_heading(state))) {
      if (match.verdict == planning::MatchVerdict::chosen ||
          match.verdict == planning::MatchVerdict::possible) {
        nearest.emplace_back(off_m, match.place);
      }
    }
  }
  std::ranges::stable_sort(nearest, {}, &std::pair<double, LanePlace>::first);
  std::vector<LanePlace> places;
  for (const auto& [off_m, place] : nearest) {
    if (std::ranges::find(places, place.lane, &LanePlace::lane) == places.end())
      places.push_back(place);
  }
  return places;
}

/// A lane goal is reached where the vehicle can be in time, not at the lane's end.
LanePlace within_reach(const map::RoadMap& road_map, const Route& to_end, LanePlace place,
                       double reach) {
  const double entry_m = to_end.length_m - road_map.lane(place.lane).length_m();
  const double s_m = std::max(reach - entry_m, 5.0);
  place.s_m = std::min(place.s_m, s_m);
  return place;
}

std::optional<Route> cheaper(std::optional<Route> a, std::optional<Route> b) {
  if (!a || (b && b->cost_s < a->cost_s)) return b;
  return a;
}

std::optional<Route> route_to(const ProblemSource& source, const std::vector<LanePlace>& starts,
                              const planning::GoalState& state, double reach) {
  std::optional<Route> best;
  for (const LanePlace& goal : goal_places(source, state)) {
    for (const LanePlace& start : starts) {
      auto answer = planning::find_route(source.road_map, {start, Sense::along}, goal);
      if (!answer.route) continue;
      if (!state.lanes.empty()) {
        const LanePlace near = within_reach(source.road_map, *answer.route, goal, reach);
        if (auto nearer = planning::find_route(source.road_map, {start, Sense::along}, near);
            nearer.route) {
          answer = std::move(nearer);
        }
      }
      best = cheaper(std::move(best), std::move(answer.route));
    }
  }
  return best;
}

/// None if no route leads to the goal.
std::optional<Route> find_route_of(const ProblemSource& source,
                                   const std::vector<LanePlace>& starts,
                                   const planning::TimedGoal& goal, double speed_mps) {
  const double until_s = goal.latest_s().value_or(kNothingAskedFor_s);
  const double reach = reach_m(speed_mps, kUsualSpeed_mps, until_s);
  std::optional<Route> best;
  bool anywhere = goal.states.empty();
  for (const planning::GoalState& state : goal.states) {
    anywhere = anywhere || state.is_anywhere();
    if (!state.is_anywhere())
      best = cheaper(std::move(best), route_to(source, starts, state, reach));
  }
  if (best || !anywhere) return best;
  const LanePlace end = straight_ahead(source.road_map, starts.front(), reach + kRoadAhead_m);
  return planning::find_route(source.road_map, {starts.front(), Sense::along}, end).route;
}

/// Places of lanes beside the start that a car may change to.
std::vector<LanePlace> places_beside(const map::RoadMap& road_map, const LanePlace& start) {
  std::vector<LanePlace> places;
  const Eigen::Vector2d here = road_map.lane(start.lane).pose_at(start.s_m).position();
  const map::LaneLinks& links = road_map.graph().of(start.lane);
  for (const auto& beside : {links.left, links.right}) {
    if (!beside || !beside->same_direction || !beside->change_allowed()) continue;
    const geometry::Polyline& centre = road_map.lane(beside->lane).centre.in_map;
    places.push_back({.lane = beside->lane, .s_m = centre.project(here).s_m});
  }
  return places;
}

/// To every lane that a goal can be met on, from each place.
std::vector<Route> all_routes(const ProblemSource& source, const std::vector<LanePlace>& starts,
                              const planning::TimedGoal& goal, double reach) {
  std::vector<Route> routes;
  const auto add = [&](std::optional<Route> route) {
    if (route) routes.push_back(*std::move(route));
  };
  for (const planning::GoalState& state : goal.states) {
    planning::GoalState one_lane = state;
    one_lane.region_in_source.clear();
    for (const LanePlace& start : starts) {
      for (const LanePlace& place : places_under(source, state)) {
        add(planning::find_route(source.road_map, {start, Sense::along}, place).route);
      }
      for (const map::LaneId lane : state.lanes) {
        one_lane.lanes = {lane};
        add(route_to(source, {start}, one_lane, reach));
      }
    }
  }
  return routes;
}

std::vector<map::LaneId> lanes_of(const Route& route) {
  std::vector<map::LaneId> lanes;
  for (const planning::RouteLeg& leg : route.legs) lanes.push_back(leg.lane);
  return lanes;
}

}  // namespace

void ProblemSource::refuse(const std::string& found, const std::string& needed,
                           const std::string& remedy) const {
  throw map::InputError({.file = file,
                         .element = "planning problem " + problem.id,
                         .found = found,
                         .needed = needed,
                         .remedy = remedy});
}

ProblemRoutes routes_of(const ProblemSource& source, const Pose2& start, double speed_mps,
                        const geometry::VehicleShape& vehicle, const planning::TimedGoal& goal) {
  std::vector<LanePlace> starts = start_places(source, start, vehicle);
  std::optional<Route> best = find_route_of(source, starts, goal, speed_mps);
  if (!best) {
    source.refuse("a goal that no route leads to", "a way over lanes that a car may use",
                  "correct the goal, or the lanelets' links");
  }
  ProblemRoutes routes{*std::move(best), {}};
  const planning::RouteLeg& first = routes.best.legs.front();
  for (const LanePlace& place :
       places_beside(source.road_map, {.lane = first.lane, .s_m = first.from_s_m})) {
    if (auto other = find_route_of(source, {place}, goal, speed_mps)) {
      routes.others.push_back(*std::move(other));
    }
    starts.push_back(place);
  }
  const double reach =
      reach_m(speed_mps, kUsualSpeed_mps, goal.latest_s().value_or(kNothingAskedFor_s));
  std::vector<Route> all = all_routes(source, starts, goal, reach);
  std::ranges::stable_sort(all, {}, &Route::cost_s);
  std::vector<std::vector<map::LaneId>> taken{lanes_of(routes.best)};
  for (const Route& other : routes.others) taken.push_back(lanes_of(other));
  for (Route& other : all) {
    if (routes.others.size() >= kMostOthers) break;
    if (std::ranges::find(taken, lanes_of(other)) != taken.end()) continue;
    taken.push_back(lanes_of(other));
    routes.others.push_back(std::move(other));
  }
  return routes;
}

}  // namespace roadbed::tools::simulation
