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
#include "roadbed/planning/obstacles/recorded_obstacles.h"
#include "roadbed/planning/speed/lead.h"
#include "roadbed/tools/simulation/common_road_obstacles.h"
#include "roadbed/tools/simulation/common_road_routes.h"

namespace roadbed::tools::inline simulation {
namespace {

using geometry::Pose2;
using map::commonroad::ObstacleRole;
using map::commonroad::PlanningProblem;
using map::commonroad::State;
using planning::Route;

constexpr double kDefaultSpeed_mps = 50.0 / 3.6;
constexpr double kLeastStep_s = 1e-3, kMostStep_s = 10.0, kFastestStart_mps = 100.0;
constexpr double kFastestUsual_mps = 130.0 / 3.6;
constexpr double kHurry = 1.1;            // of the mean speed to a goal
constexpr double kStopping_s = 10.0;      // to come to rest after the goal is missed
constexpr double kNothingAsked_s = 10.0;  // a drive without a goal
constexpr double kBeyondGoal_m = 100.0;   // the line goes on past the goal

double exact(const ProblemSource& source,
             const std::optional<map::commonroad::Range<double>>& range, const char* what) {
  if (!range) {
    source.refuse(fmt::format("an initial state without {}", what), "one number", "add it");
  }
  return 0.5 * (range->least + range->most);
}

/// CommonRoad gives the vehicle's centre.
Pose2 rear_axle(const ProblemSource& source, const geometry::VehicleShape& vehicle) {
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

planning::GoalState goal_state(const ProblemSource& source, const State& from) {
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
double start_speed_mps(const ProblemSource& source) {
  const double speed = exact(source, source.problem.initial_state.speed_mps, "a velocity");
  if (!(speed >= 0.0 && speed <= kFastestStart_mps)) {
    source.refuse(fmt::format("a start at {} m/s", speed),
                  fmt::format("0 to {} m/s", kFastestStart_mps), "correct the initial state");
  }
  return speed;
}

planning::TimedGoal goal_of(const ProblemSource& source) {
  planning::TimedGoal goal{.step_s = source.step_s, .states = {}};
  for (const State& state : source.problem.goals) goal.states.push_back(goal_state(source, state));
  return goal;
}

/// Where the file knows no limit: what towns allow, or what start and goal show to be usual, or
/// what it takes to be there in time, speeding up evenly or having sped up at once.
double usual_speed_mps(double start_mps, const planning::TimedGoal& goal, double way_m) {
  double usual = std::max(kDefaultSpeed_mps, start_mps);
  for (const planning::GoalState& state : goal.states) {
    if (std::isfinite(state.speed_mps.least)) usual = std::max(usual, state.speed_mps.least + 1.0);
  }
  if (goal.latest_s().value_or(0.0) <= 0.0) return usual;
  const double mean_mps = way_m / *goal.latest_s();
  const double even_mps = 2.0 * mean_mps - start_mps;
  return std::max({usual, kHurry * mean_mps, std::min(even_mps, kFastestUsual_mps)});
}

Scenario scenario_of(const std::filesystem::path& file, const std::string& benchmark_id,
                     double speed_mps, const planning::TimedGoal& goal) {
  Scenario scenario;
  scenario.file = scenario.map_file = file;
  scenario.name = benchmark_id.empty() ? file.stem().string() : benchmark_id;
  scenario.start_speed_mps = speed_mps;
  scenario.pedals = false;  // its speed search foresees the lag exactly
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
  const map::commonroad::Scenario from =
      map::commonroad::parse_scenario(bytes, map::input_name(file));
  if (from.planning_problems.empty()) {
    throw map::InputError({.file = map::input_name(file),
                           .element = "commonRoad",
                           .found = "no planning problem",
                           .needed = "one to solve",
                           .remedy = "add a planningProblem"});
  }
  auto kept_map = inputs.road_map(file);
  const map::RoadMap& road_map = *kept_map;
  const PlanningProblem& problem = from.planning_problems.front();
  const ProblemSource source{map::input_name(file), road_map, problem, from.time_step_s};
  if (!(from.time_step_s >= kLeastStep_s && from.time_step_s <= kMostStep_s)) {
    source.refuse(fmt::format("time steps of {} s", from.time_step_s),
                  fmt::format("{} to {} s", kLeastStep_s, kMostStep_s), "correct timeStepSize");
  }
  const double speed_mps = start_speed_mps(source);
  planning::TimedGoal goal = goal_of(source);
  Scenario scenario = scenario_of(file, from.benchmark_id, speed_mps, goal);
  changes.apply_to(scenario);
  const Pose2 start = rear_axle(source, scenario.vehicle);
  ProblemRoutes routes = routes_of(source, start, speed_mps, scenario.vehicle, goal);
  const planning::ReferenceLineOptions line_options{
      .default_speed_mps = usual_speed_mps(speed_mps, goal, routes.best.length_m),
      .extend_m = kBeyondGoal_m,
      .corner_vehicle = scenario.vehicle};
  planning::ReferenceLine line =
      planning::ReferenceLine::along(road_map, routes.best, line_options);
  scenario.lights = light_cycles(from, problem.initial_state.time_step.least);
  std::vector<planning::StopPoint> places =
      stop_points(road_map, routes.best, line, scenario.lights);
  std::vector<planning::ReferenceLine> other_lines;
  std::vector<std::vector<planning::StopPoint>> other_places;
  for (const Route& other : routes.others) {
    other_lines.push_back(planning::ReferenceLine::along(road_map, other, line_options));
    other_places.push_back(stop_points(road_map, other, other_lines.back(), scenario.lights));
  }
  World world{{.kept_map = std::move(kept_map),
               .field = {},
               .start = start,
               .route = std::move(routes.best),
               .line = std::move(line),
               .obstacles = {},
               .goal = std::move(goal),
               .lights = scenario.lights,
               .stop_points = std::move(places),
               .other_lines = std::move(other_lines),
               .other_stop_points = std::move(other_places)}};
  const ProblemSource placed{map::input_name(file), world.road_map, problem, from.time_step_s};
  world.obstacles =
      obstacles_of(from, placed, world.start, scenario.vehicle, changes.drops_ego_recording);
  return {.scenario = std::move(scenario),
          .world = std::move(world),
          .benchmark_id = from.benchmark_id,
          .version = from.version,
          .problem_id = problem.id,
          .start_step = problem.initial_state.time_step.least};
}

std::vector<planning::LightCycle> light_cycles(const map::commonroad::Scenario& from,
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

}  // namespace roadbed::tools::simulation
