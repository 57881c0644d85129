#include "roadbed/tools/simulation/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/formats.h"
#include "roadbed/map/load_map.h"
#include "roadbed/planning/behaviour/lead.h"
#include "roadbed/planning/obstacles/recorded_obstacles.h"
#include "roadbed/planning/route/match_place.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools::inline simulation {
namespace {

using geometry::Pose2;
using map::LanePlace;
using map::commonroad::ObstacleRole;
using map::commonroad::PlanningProblem;
using map::commonroad::State;
using planning::Route;
using planning::Sense;

constexpr double kDefaultSpeed_mps = 50.0 / 3.6;
constexpr double kLeastStep_s = 1e-3, kMostStep_s = 10.0, kFastestStart_mps = 100.0;
constexpr double kStopping_s = 10.0;      // to come to rest after the goal is missed
constexpr double kNothingAsked_s = 10.0;  // a drive without a goal
constexpr double kRoadAhead_m = 120.0;    // beyond what is driven, to brake on
constexpr double kBeyondGoal_m = 100.0;   // the line goes on past the goal
constexpr double kAtGoal_m = 3.0;         // a region's middle may lie so far beside its lane

struct Source {
  std::string file;
  const map::RoadMap& road_map;
  const PlanningProblem& problem;
  double step_s;

  [[noreturn]] void refuse(const std::string& found, const std::string& needed,
                           const std::string& remedy) const {
    throw map::InputError({.file = file,
                           .element = "planning problem " + problem.id,
                           .found = found,
                           .needed = needed,
                           .remedy = remedy});
  }
};

double exact(const Source& source, const std::optional<map::commonroad::Range<double>>& range,
             const char* what) {
  if (!range) {
    source.refuse(fmt::format("an initial state without {}", what), "one number", "add it");
  }
  return 0.5 * (range->least + range->most);
}

/// CommonRoad gives the vehicle's centre.
Pose2 rear_axle(const Source& source, const geometry::VehicleShape& vehicle) {
  const State& start = source.problem.initial_state;
  if (!start.position_m) {
    source.refuse("an initial state without a point", "its position", "add it");
  }
  const Eigen::Vector2d place = source.road_map.to_map(*start.position_m);
  const Pose2 centre{place.x(), place.y(), exact(source, start.heading_rad, "an orientation")};
  return centre * Pose2{vehicle.rear_overhang_m - 0.5 * vehicle.length_m, 0.0, 0.0};
}

planning::Window seconds(const map::commonroad::Range<long>& steps, long start_step,
                         double step_s) {
  return {step_s * static_cast<double>(steps.least - start_step),
          step_s * static_cast<double>(steps.most - start_step)};
}

planning::Window window(const map::commonroad::Range<double>& range) {
  return {range.least, range.most};
}

planning::GoalState goal_state(const Source& source, const State& from) {
  planning::GoalState state{
      .time_s =
          seconds(from.time_step, source.problem.initial_state.time_step.least, source.step_s),
      .speed_mps = from.speed_mps ? window(*from.speed_mps) : planning::Window{},
      .heading_rad = {},
      .region_in_source = from.region,
      .lanes = {}};
  if (from.heading_rad) state.heading_rad = window(*from.heading_rad);
  for (const std::string& name : from.lanelets) {
    const auto lane = source.road_map.find_lane(name);
    if (!lane) {
      source.refuse(fmt::format("a goal on lanelet {}", name), "a lanelet of the file",
                    "correct the reference");
    }
    state.lanes.push_back(*lane);
  }
  return state;
}

/// The planner drives forwards only.
double start_speed_mps(const Source& source) {
  const double speed = exact(source, source.problem.initial_state.speed_mps, "a velocity");
  if (!(speed >= 0.0 && speed <= kFastestStart_mps)) {
    source.refuse(fmt::format("a start at {} m/s", speed),
                  fmt::format("0 to {} m/s", kFastestStart_mps), "correct the initial state");
  }
  return speed;
}

planning::TimedGoal goal_of(const Source& source) {
  planning::TimedGoal goal{.step_s = source.step_s, .states = {}};
  for (const State& state : source.problem.goals) goal.states.push_back(goal_state(source, state));
  return goal;
}

/// Lanes that the vehicle's centre may be on, the best match first, at the rear axle's station.
std::vector<LanePlace> start_places(const Source& source, const Pose2& start,
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
    if (match.sense == planning::Sense::against) continue;
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
    const std::optional<map::LaneId> next = straightest(road_map, at.lane);
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

/// Places of a goal state that a route may lead to.
std::vector<LanePlace> goal_places(const Source& source, const planning::GoalState& state) {
  std::vector<LanePlace> places;
  for (const map::LaneId lane : state.lanes) {
    places.push_back({.lane = lane, .s_m = source.road_map.lane(lane).length_m()});
  }
  if (!state.region_in_source.empty()) {
    const Eigen::Vector2d middle =
        source.road_map.to_map(planning::middle_of(state.region_in_source));
    std::optional<double> heading;
    if (state.heading_rad) heading = 0.5 * (state.heading_rad->least + state.heading_rad->most);
    for (const auto& match :
         planning::match_place(source.road_map, middle, heading, {.reach_m = kAtGoal_m})) {
      if (match.verdict == planning::MatchVerdict::chosen) places.push_back(match.place);
    }
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

std::optional<Route> route_to(const Source& source, const std::vector<LanePlace>& starts,
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
std::optional<Route> find_route_of(const Source& source, const std::vector<LanePlace>& starts,
                                   const planning::TimedGoal& goal, double speed_mps) {
  const double until_s = goal.latest_s().value_or(kNothingAsked_s);
  const double reach = reach_m(speed_mps, kDefaultSpeed_mps, until_s);
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

Route route_of(const Source& source, const std::vector<LanePlace>& starts,
               const planning::TimedGoal& goal, double speed_mps) {
  std::optional<Route> route = find_route_of(source, starts, goal, speed_mps);
  if (!route) {
    source.refuse("a goal that no route leads to", "a way over lanes that a car may use",
                  "correct the goal, or the lanelets' links");
  }
  return *std::move(route);
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

/// Where the file knows no limit: what towns allow, or what start and goal show to be usual.
double usual_speed_mps(double start_mps, const planning::TimedGoal& goal) {
  double usual = std::max(kDefaultSpeed_mps, start_mps);
  for (const planning::GoalState& state : goal.states) {
    if (std::isfinite(state.speed_mps.least)) usual = std::max(usual, state.speed_mps.least + 1.0);
  }
  return usual;
}

/// A recording is one state for each time step: where one is missing nobody knows where it was.
void refuse_gaps(const std::string& file, const map::commonroad::Obstacle& obstacle) {
  long last = obstacle.initial_state->time_step.least;
  for (const State& state : obstacle.trajectory) {
    const long step = state.time_step.least;
    if (step != last + 1) {
      throw map::InputError({.file = file,
                             .element = "obstacle " + obstacle.id,
                             .found = fmt::format("time step {} after {}", step, last),
                             .needed = "a state for each time step",
                             .remedy = "add what is missing, or cut the trajectory off before"});
    }
    last = step;
  }
}

/// What a file's lights show: red with yellow is red, and one that is off is dark.
std::vector<planning::LightCycle> lights_of(const map::commonroad::Scenario& from,
                                            long start_step) {
  std::vector<planning::LightCycle> lights;
  for (const map::commonroad::TrafficLight& light : from.lights) {
    planning::LightCycle shown{.signals = {light.id}, .pointer = {}, .phases = {}};
    bool is_on = light.is_active;
    for (const map::commonroad::LightPhase& phase : light.cycle) {
      const double duration_s = from.time_step_s * phase.duration_steps;
      is_on = is_on && phase.colour != "inactive";
      if (!(duration_s > 0.0)) continue;
      shown.phases.push_back({phase.colour == "green"    ? planning::LightColour::green
                              : phase.colour == "yellow" ? planning::LightColour::yellow
                                                         : planning::LightColour::red,
                              duration_s});
    }
    shown.offset_s = from.time_step_s * (light.offset_steps - static_cast<double>(start_step));
    if (is_on && !shown.phases.empty()) lights.push_back(std::move(shown));
  }
  return lights;
}

void add_obstacles(const map::commonroad::Scenario& from, const Source& source, World& world) {
  const planning::RecordingClock clock{source.problem.initial_state.time_step.least,
                                       from.time_step_s};
  for (const map::commonroad::Obstacle& obstacle : from.obstacles) {
    const bool can_be_hit =
        obstacle.role == ObstacleRole::fixed || obstacle.role == ObstacleRole::dynamic;
    if (!can_be_hit) continue;
    refuse_gaps(source.file, obstacle);
    world.obstacles.push_back(
        planning::obstacle_in_map(world.road_map, planning::recorded_obstacle(obstacle, clock)));
  }
}

void refuse_overlap(const Source& source, const World& world,
                    const geometry::VehicleShape& vehicle) {
  const geometry::Rectangle body = geometry::body_at(world.start, vehicle);
  for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
    if (!world.obstacles[i].is_there(0.0)) continue;
    if (geometry::distance_m(body, rectangle_at(world.obstacles[i], 0.0)) > 0.0) continue;
    source.refuse(fmt::format("obstacle {} touches the ego at the start", world.obstacles[i].id),
                  "room to start from", "move one of the two");
  }
}

Scenario scenario_of(const std::filesystem::path& file, const std::string& benchmark_id,
                     double speed_mps, const planning::TimedGoal& goal) {
  Scenario scenario;
  scenario.file = scenario.map_file = file;
  scenario.name = benchmark_id.empty() ? file.stem().string() : benchmark_id;
  scenario.start_speed_mps = speed_mps;
  const double until_s = std::max(0.0, goal.latest_s().value_or(kNothingAsked_s));
  scenario.duration_s = std::min(until_s + kStopping_s, 3600.0);
  return scenario;
}

}  // namespace

bool is_common_road(const std::filesystem::path& file) {
  const map::Format* format = map::format_of(file);
  return format != nullptr && format->name == "CommonRoad";
}

CommonRoadDrive read_common_road_drive(const std::filesystem::path& file,
                                       const ScenarioChanges& changes, const Inputs& inputs) {
  const std::string bytes = map::read_file(file);
  const map::commonroad::Scenario from = map::commonroad::parse_scenario(bytes, file.string());
  if (from.planning_problems.empty()) {
    throw map::InputError({.file = file.string(),
                           .element = "commonRoad",
                           .found = "no planning problem",
                           .needed = "one to solve",
                           .remedy = "add a planningProblem"});
  }
  auto kept_map = inputs.road_map(file);
  const map::RoadMap& road_map = *kept_map;
  const PlanningProblem& problem = from.planning_problems.front();
  const Source source{file.string(), road_map, problem, from.time_step_s};
  if (!(from.time_step_s >= kLeastStep_s && from.time_step_s <= kMostStep_s)) {
    source.refuse(fmt::format("time steps of {} s", from.time_step_s),
                  fmt::format("{} to {} s", kLeastStep_s, kMostStep_s), "correct timeStepSize");
  }
  const double speed_mps = start_speed_mps(source);
  planning::TimedGoal goal = goal_of(source);
  Scenario scenario = scenario_of(file, from.benchmark_id, speed_mps, goal);
  changes.apply_to(scenario);
  const Pose2 start = rear_axle(source, scenario.vehicle);
  Route route = route_of(source, start_places(source, start, scenario.vehicle), goal, speed_mps);
  const planning::ReferenceLineOptions line_options{
      .default_speed_mps = usual_speed_mps(speed_mps, goal), .extend_m = kBeyondGoal_m};
  planning::ReferenceLine line = planning::ReferenceLine::along(road_map, route, line_options);
  scenario.lights = lights_of(from, problem.initial_state.time_step.least);
  std::vector<planning::StopPoint> places = stop_points(road_map, route, line, scenario.lights);
  std::vector<planning::ReferenceLine> other_lines;
  std::vector<std::vector<planning::StopPoint>> other_places;
  const planning::RouteLeg& first = route.legs.front();
  for (const LanePlace& place :
       places_beside(road_map, {.lane = first.lane, .s_m = first.from_s_m})) {
    if (const auto other = find_route_of(source, {place}, goal, speed_mps)) {
      other_lines.push_back(planning::ReferenceLine::along(road_map, *other, line_options));
      other_places.push_back(stop_points(road_map, *other, other_lines.back(), scenario.lights));
    }
  }
  World world{{.kept_map = std::move(kept_map),
               .field = {},
               .start = start,
               .route = std::move(route),
               .line = std::move(line),
               .obstacles = {},
               .goal = std::move(goal),
               .lights = scenario.lights,
               .stop_points = std::move(places),
               .other_lines = std::move(other_lines),
               .other_stop_points = std::move(other_places)}};
  const Source placed{file.string(), world.road_map, problem, from.time_step_s};
  add_obstacles(from, placed, world);
  refuse_overlap(placed, world, scenario.vehicle);
  return {.scenario = std::move(scenario),
          .world = std::move(world),
          .benchmark_id = from.benchmark_id,
          .version = from.version,
          .problem_id = problem.id,
          .start_step = problem.initial_state.time_step.least};
}

}  // namespace roadbed::tools::simulation
