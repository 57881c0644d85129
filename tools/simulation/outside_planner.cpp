#include "roadbed/tools/simulation/outside_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/tools/cli/line_process.h"
#include "roadbed/tools/files/trajectory_csv.h"

namespace roadbed::tools::inline simulation {
namespace {

constexpr double kSeenOver_s = 0.1;  // a speed is that of the last cycle, if there is one
constexpr double kSceneStep_m = 1.0;
constexpr std::size_t kLeastColumns = 5, kMostColumns = 8;
constexpr std::size_t kMostRows = 100'000;

constexpr const char* kWhatIsNeeded =
    "{\"trajectory\":[[t_s,x_m,y_m,heading_rad,speed_mps],…]} with increasing times";

SeenObstacle seen(const planning::Obstacle& obstacle, const World& world, double t_s) {
  const geometry::Pose2 now = obstacle.pose_at(t_s);
  const double before_s = t_s - kSeenOver_s;
  const bool was_there = before_s >= 0.0 && obstacle.is_there(before_s);
  const geometry::Pose2 before = obstacle.pose_at(before_s);
  const Eigen::Vector2d place = world.road_map.to_source(now.position());
  return {.id = obstacle.id,
          .kind = obstacle.kind,
          .length_m = obstacle.length_m,
          .width_m = obstacle.width_m,
          .pose = {place.x(), place.y(), now.heading_rad},
          .speed_mps = was_there ? (now.position() - before.position()).norm() / kSeenOver_s
                                 : obstacle.motion.at(t_s).speed_mps};
}

Json shape_json(const geometry::VehicleShape& shape) {
  return {{"length_m", shape.length_m},
          {"width_m", shape.width_m},
          {"rear_overhang_m", shape.rear_overhang_m},
          {"wheelbase_m", shape.wheelbase_m},
          {"height_m", shape.height_m},
          {"max_steering_rad", shape.max_steering_rad},
          {"max_steering_rate_radps", shape.max_steering_rate_radps}};
}

Json line_json(const World& world) {
  Json rows = Json::array();
  const planning::ReferenceLine& line = world.line;
  const double end_m = line.length_m();
  for (int i = 0;; ++i) {
    const double s_m = std::min(i * kSceneStep_m, end_m);
    const planning::ReferencePoint point = line.at(s_m);
    const planning::Corridor room = line.corridor_at(s_m);
    const Eigen::Vector2d place = world.road_map.to_source(point.in_map);
    rows.push_back({s_m, place.x(), place.y(), point.heading_rad, point.curvature_per_m,
                    room.left_m, room.right_m, room.speed_limit_mps});
    if (s_m >= end_m) break;
  }
  return {{"columns",
           {"s_m", "x_m", "y_m", "heading_rad", "curvature_per_m", "left_m", "right_m",
            "speed_limit_mps"}},
          {"rows", std::move(rows)}};
}

Json scene_json(const Observation& seen) {
  return {{"format", "roadbed planner 1"},
          {"scenario", seen.scenario.name},
          {"map", seen.scenario.map_file.string()},
          {"crs", seen.world.road_map.crs()},
          {"duration_s", seen.scenario.duration_s},
          {"desired_speed_mps", seen.scenario.options.desired_speed_mps},
          {"vehicle", shape_json(seen.scenario.vehicle)},
          {"goal", {{"x_m", seen.goal.x()}, {"y_m", seen.goal.y()}}},
          {"goal_s_m", seen.world.line.goal_s_m()},
          {"reference", line_json(seen.world)}};
}

geometry::TrajectoryPoint row_of(const JsonNode& node) {
  constexpr double most = 1e9;
  const std::vector<JsonNode> numbers = node.elements();
  if (numbers.size() < kLeastColumns || numbers.size() > kMostColumns) {
    node.refuse(fmt::format("has {} numbers", numbers.size()), "5 to 8", "see tools/simulation");
  }
  std::array<double, kMostColumns> values{};
  for (std::size_t i = 0; i < numbers.size(); ++i) values[i] = numbers[i].number({-most, most});
  return {values[0], values[1], values[2], values[3], values[4], values[5], values[6], values[7]};
}

geometry::Trajectory trajectory_in(const JsonNode& node) {
  if (node.value().is_null()) return {};
  std::vector<geometry::TrajectoryPoint> rows;
  const std::vector<JsonNode> elements = node.elements();
  if (elements.size() > kMostRows) {
    node.refuse(fmt::format("has {} rows", elements.size()), "100000 at most", "give fewer");
  }
  for (const JsonNode& element : elements) {
    rows.push_back(row_of(element));
    if (rows.size() > 1 && !(rows.back().t_s > rows[rows.size() - 2].t_s)) {
      element.refuse("is no later than the row before", "times that increase", "sort the rows");
    }
  }
  if (rows.empty()) return {};
  if (const auto fault = implausible_row(rows)) {
    node.refuse(fmt::format("row {}, {}: {}", fault->row, fault->column, fault->found),
                fault->needed, fault->remedy);
  }
  return geometry::Trajectory(std::move(rows));
}

/// One that is asked line by line.
class PlannerProcess {
 public:
  PlannerProcess(std::string command, double limit_s)
      : command_(std::move(command)),
        limit_s_(limit_s),
        process_({.file = "/bin/sh",
                  .words = {"sh", "-c", command_},
                  .what = "the planner's process",
                  .remedy = "see whether /bin/sh can be run"}) {}

  OutsidePlan plan(const Observation& seen) {
    const LineProcess::Answer answer = process_.ask(
        map::json_text(observation_json(seen, std::exchange(is_first_, false))), limit_s_);
    const std::string place = fmt::format("{:.1f} s", seen.t_s);
    if (answer.is_late) {
      refuse(place, fmt::format("gave no answer within {:g} s and was ended", limit_s_));
    }
    if (!answer.death.empty()) refuse(place, answer.death + ", without an answer");
    return parse_outside_plan(answer.line, command_ + ": " + place);
  }

 private:
  [[noreturn]] void refuse(const std::string& place, const std::string& found) const {
    throw map::InputError({.file = command_,
                           .place = place,
                           .found = found,
                           .needed = "one line of JSON for each line that it is given",
                           .remedy = "flush standard output after each line; the planner's own "
                                     "messages belong on standard error"});
  }

  std::string command_;
  double limit_s_;
  LineProcess process_;
  bool is_first_ = true;
};

}  // namespace

Observation observe(const Scenario& scenario, const World& world, double t_s,
                    const planning::VehicleState& measured) {
  const Eigen::Vector2d in_map = measured.map_from_vehicle.position();
  const Eigen::Vector2d place = world.road_map.to_source(in_map);
  const geometry::LinePosition on_line = world.line.project(in_map);
  const double goal_s_m = world.line.goal_s_m();
  Observation seen_now{
      .t_s = t_s,
      .ego = {.t_s = t_s,
              .x_m = place.x(),
              .y_m = place.y(),
              .heading_rad = measured.map_from_vehicle.heading_rad,
              .speed_mps = measured.speed_mps,
              .acceleration_mps2 = measured.acceleration_mps2,
              .steering_rad = measured.steering_rad,
              .curvature_per_m = std::tan(measured.steering_rad) / scenario.vehicle.wheelbase_m},
      .obstacles = {},
      .goal = world.road_map.to_source(world.line.at(goal_s_m).in_map),
      .s_m = on_line.s_m,
      .d_m = on_line.d_m,
      .scenario = scenario,
      .world = world};
  for (const planning::Obstacle& obstacle : world.obstacles) {
    if (obstacle.is_there(t_s)) seen_now.obstacles.push_back(seen(obstacle, world, t_s));
  }
  return seen_now;
}

Json observation_json(const Observation& seen, bool with_scene) {
  Json json = {{"t_s", seen.t_s},
               {"ego",
                {{"x_m", seen.ego.x_m},
                 {"y_m", seen.ego.y_m},
                 {"heading_rad", seen.ego.heading_rad},
                 {"speed_mps", seen.ego.speed_mps},
                 {"acceleration_mps2", seen.ego.acceleration_mps2},
                 {"steering_rad", seen.ego.steering_rad},
                 {"s_m", seen.s_m},
                 {"d_m", seen.d_m}}}};
  Json obstacles = Json::array();
  for (const SeenObstacle& obstacle : seen.obstacles) {
    obstacles.push_back({{"id", obstacle.id},
                         {"kind", obstacle.kind},
                         {"x_m", obstacle.pose.x_m},
                         {"y_m", obstacle.pose.y_m},
                         {"heading_rad", obstacle.pose.heading_rad},
                         {"speed_mps", obstacle.speed_mps},
                         {"length_m", obstacle.length_m},
                         {"width_m", obstacle.width_m}});
  }
  json["obstacles"] = std::move(obstacles);
  Json lights = Json::array();
  for (const planning::LightCycle& light : seen.world.lights) {
    for (const std::string& signal : light.signals) {
      lights.push_back({{"signal", signal},
                        {"colour", planning::to_string(planning::colour_at(light, seen.t_s))}});
    }
  }
  json["lights"] = std::move(lights);
  if (with_scene) json["scene"] = scene_json(seen);
  return json;
}

OutsidePlan parse_outside_plan(std::string_view bytes, const std::string& name) {
  const nlohmann::json document = parse_json_strictly(bytes, name);
  const JsonNode root(document, name);
  if (!document.is_object() || !document.contains("trajectory")) {
    root.refuse("is no answer", kWhatIsNeeded, "see tools/simulation/README.md");
  }
  root.require_object({"trajectory", "reason", "t_s", "command", "behaviour", "at_goal", "lead",
                       "hypotheses", "tracks", "error"});
  OutsidePlan plan{.trajectory = trajectory_in(root.at("trajectory"))};
  if (const auto reason = root.find("reason")) plan.reason = map::one_line(reason->text());
  return plan;
}

OutsidePlanner planner_process(const std::string& command, double limit_s) {
  const auto process = std::make_shared<PlannerProcess>(command, limit_s);
  return [process](const Observation& seen) { return process->plan(seen); };
}

}  // namespace roadbed::tools::simulation
