#include "roadbed/map/commonroad/scenario.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/files/xml.h"

namespace roadbed::map::commonroad {
namespace {

const Eigen::Vector2d kSourceOrigin(0.0, 0.0);

Eigen::Vector2d point_of(const XmlDocument& xml, pugi::xml_node point) {
  return read_point(xml, point, kSourceOrigin).head<2>();
}

/// `exact`, or `intervalStart` and `intervalEnd`.
Range<double> read_range(const XmlDocument& xml, pugi::xml_node node) {
  if (node.child("exact")) {
    const double value = xml.text_number(node, "exact");
    return {value, value};
  }
  const Range<double> range = {xml.text_number(node, "intervalStart"),
                               xml.text_number(node, "intervalEnd")};
  if (range.least > range.most) {
    xml.refuse(node, fmt::format("from {} to {}", range.least, range.most),
               "a start that is not after the end", "correct the interval");
  }
  return range;
}

Range<long> read_time_step(const XmlDocument& xml, pugi::xml_node parent) {
  const pugi::xml_node node = parent.child("time");
  if (!node) xml.refuse(parent, "element <time> is missing", "a time step", "add it");
  const Range<double> range = read_range(xml, node);
  constexpr double last_step = 1e9;
  for (const double step : {range.least, range.most}) {
    if (step != std::floor(step) || step < 0.0 || step > last_step) {
      xml.refuse(node, fmt::format("time step {}", step), "a whole number from 0 to 1e9",
                 "correct the value");
    }
  }
  return {static_cast<long>(range.least), static_cast<long>(range.most)};
}

double positive(const XmlDocument& xml, pugi::xml_node node, const char* child) {
  const double value = xml.text_number(node, child);
  if (!(value > 0.0)) {
    xml.refuse(node, fmt::format("{} {}", child, value), "more than 0", "correct the value");
  }
  return value;
}

RectangleShape read_rectangle(const XmlDocument& xml, pugi::xml_node node) {
  RectangleShape shape;
  shape.length_m = positive(xml, node, "length");
  shape.width_m = positive(xml, node, "width");
  if (node.child("orientation")) shape.heading_rad = xml.text_number(node, "orientation");
  if (node.child("center")) shape.centre_m = point_of(xml, node.child("center"));
  return shape;
}

CircleShape read_circle(const XmlDocument& xml, pugi::xml_node node) {
  CircleShape shape;
  shape.radius_m = positive(xml, node, "radius");
  if (node.child("center")) shape.centre_m = point_of(xml, node.child("center"));
  return shape;
}

PolygonShape read_polygon(const XmlDocument& xml, pugi::xml_node node) {
  PolygonShape shape;
  for (const pugi::xml_node point : node.children("point")) {
    shape.corners_m.push_back(point_of(xml, point));
  }
  if (shape.corners_m.size() < 3) {
    xml.refuse(node, fmt::format("{} points", shape.corners_m.size()), "at least 3",
               "correct the polygon");
  }
  return shape;
}

/// The shapes that an element holds; those of a `shapeGroup` are found one element further down.
void add_shapes(const XmlDocument& xml, pugi::xml_node parent, bool within_group, Shape& shape) {
  for (const pugi::xml_node node : parent.children()) {
    const std::string_view kind = node.name();
    if (kind == "rectangle") shape.emplace_back(read_rectangle(xml, node));
    if (kind == "circle") shape.emplace_back(read_circle(xml, node));
    if (kind == "polygon") shape.emplace_back(read_polygon(xml, node));
    if (kind != "shapeGroup" && kind != "absoluteShapeGroup") continue;
    if (within_group) xml.refuse(node, "a group within a group", "one group", "take it apart");
    for (const pugi::xml_node part : node.children("shape")) add_shapes(xml, part, true, shape);
  }
}

Shape read_shape(const XmlDocument& xml, pugi::xml_node parent) {
  Shape shape;
  add_shapes(xml, parent, false, shape);
  return shape;
}

void read_position(const XmlDocument& xml, pugi::xml_node node, State& state) {
  if (node.child("point")) state.position_m = point_of(xml, node.child("point"));
  state.region = read_shape(xml, node);
  state.lanelets = references(node, "lanelet");
  if (!state.position_m && state.region.empty() && state.lanelets.empty()) {
    xml.refuse(node, "a position without a place", "a point, a shape or lanelets", "add one");
  }
}

State read_state(const XmlDocument& xml, pugi::xml_node node) {
  State state;
  state.time_step = read_time_step(xml, node);
  for (const pugi::xml_node child : node.children()) {
    const std::string_view name = child.name();
    if (name.empty() || name == "time") continue;
    if (name == "position") {
      read_position(xml, child, state);
    } else if (name == "orientation") {
      state.heading_rad = read_range(xml, child);
    } else if (name == "velocity") {
      state.speed_mps = read_range(xml, child);
    } else if (name == "acceleration") {
      state.acceleration_mps2 = read_range(xml, child);
    } else {
      state.others.emplace_back(name, read_range(xml, child));
    }
  }
  return state;
}

/// 2018b writes the role as an element, 2020a as the obstacle's own name.
ObstacleRole role_of(const XmlDocument& xml, pugi::xml_node node) {
  const std::string_view name = node.name();
  const std::string role = text_of(node.child("role"));
  if (name == "staticObstacle" || role == "static") return ObstacleRole::fixed;
  if (name == "dynamicObstacle" || role == "dynamic") return ObstacleRole::dynamic;
  if (name == "environmentObstacle") return ObstacleRole::environment;
  if (name == "phantomObstacle") return ObstacleRole::phantom;
  xml.refuse(node, fmt::format("role \"{}\"", role), "static or dynamic", "correct the role");
}

void read_prediction(const XmlDocument& xml, pugi::xml_node node, Obstacle& obstacle) {
  for (const pugi::xml_node state : node.child("trajectory").children("state")) {
    obstacle.trajectory.push_back(read_state(xml, state));
  }
  for (const pugi::xml_node part : node.child("occupancySet").children("occupancy")) {
    obstacle.occupancy_set.push_back(
        {read_time_step(xml, part), read_shape(xml, part.child("shape"))});
  }
}

Obstacle read_obstacle(const XmlDocument& xml, pugi::xml_node node) {
  Obstacle obstacle;
  obstacle.id = xml.text(node, "id");
  obstacle.type = text_of(node.child("type"));
  obstacle.role = role_of(xml, node);
  obstacle.shape = read_shape(xml, node.child("shape"));
  if (node.child("initialState")) {
    obstacle.initial_state = read_state(xml, node.child("initialState"));
  }
  read_prediction(xml, node, obstacle);
  const bool moves = obstacle.role == ObstacleRole::fixed || obstacle.role == ObstacleRole::dynamic;
  if (moves && (!obstacle.initial_state || obstacle.shape.empty())) {
    xml.refuse(node, "no shape or no initial state", "both", "add them, or remove the obstacle");
  }
  return obstacle;
}

PlanningProblem read_problem(const XmlDocument& xml, pugi::xml_node node) {
  PlanningProblem problem;
  problem.id = xml.text(node, "id");
  if (!node.child("initialState")) {
    xml.refuse(node, "element <initialState> is missing", "a state to start from", "add it");
  }
  problem.initial_state = read_state(xml, node.child("initialState"));
  for (const pugi::xml_node goal : node.children("goalState")) {
    problem.goals.push_back(read_state(xml, goal));
  }
  return problem;
}

TrafficLight read_light(pugi::xml_node node) {
  const pugi::xml_node cycle = node.child("cycle");
  TrafficLight light{.id = node.attribute("id").value(),
                     .cycle = {},
                     .offset_steps = cycle.child("timeOffset").text().as_double(),
                     .is_active = text_of(node.child("active")) != "false"};
  for (const pugi::xml_node element : cycle.children("cycleElement")) {
    light.cycle.push_back(
        {text_of(element.child("color")), element.child("duration").text().as_double()});
  }
  return light;
}

/// 2018b lists the tags in an attribute, 2020a as elements.
std::vector<std::string> read_tags(pugi::xml_node root) {
  std::vector<std::string> tags;
  for (const pugi::xml_node tag : root.child("scenarioTags").children()) {
    if (tag.type() == pugi::node_element) tags.emplace_back(tag.name());
  }
  std::string_view words = root.attribute("tags").value();
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    if (end > 0) tags.emplace_back(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return tags;
}

double read_time_step_s(const XmlDocument& xml) {
  const double time_step_s = xml.number(xml.root(), "timeStepSize");
  if (!(time_step_s > 0.0)) {
    xml.refuse(xml.root(), fmt::format("timeStepSize=\"{}\"", time_step_s), "more than 0 s",
               "correct the value");
  }
  return time_step_s;
}

}  // namespace

Scenario parse_scenario(const std::string& bytes, const std::string& name) {
  const XmlDocument xml(bytes, name);
  const pugi::xml_node root = xml.root();
  if (std::string_view(root.name()) != "commonRoad") {
    xml.refuse(root, fmt::format("root element <{}>", root.name()), "<commonRoad>",
               "give a CommonRoad file");
  }
  Scenario scenario;
  scenario.benchmark_id = root.attribute("benchmarkID").value();
  scenario.version = root.attribute("commonRoadVersion").value();
  for (const pugi::xml_attribute attribute : root.attributes()) {
    scenario.attributes.emplace_back(attribute.name(), attribute.value());
  }
  scenario.tags = read_tags(root);
  scenario.time_step_s = read_time_step_s(xml);
  for (const pugi::xml_node child : root.children()) {
    const std::string_view kind = child.name();
    if (kind == "planningProblem") {
      scenario.planning_problems.push_back(read_problem(xml, child));
    } else if (kind == "obstacle" || kind.ends_with("Obstacle")) {
      scenario.obstacles.push_back(read_obstacle(xml, child));
    } else if (kind == "trafficLight") {
      scenario.lights.push_back(read_light(child));
    }
  }
  return scenario;
}

}  // namespace roadbed::map::commonroad
