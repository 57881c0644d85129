#include "roadbed/tools/simulation/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/planning/behaviour/route_line.h"
#include "roadbed/planning/obstacles/lanes_ahead.h"
#include "roadbed/planning/obstacles/obstacle_limits.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/planning/speed/lead.h"
#include "roadbed/tools/cli/place.h"
#include "roadbed/tools/files/obstacles_csv.h"
#include "roadbed/tools/simulation/obstacle_motion.h"

namespace roadbed::tools::inline simulation {
namespace {

using geometry::Pose2;
using planning::Obstacle;
using planning::ReferenceLine;
using planning::Route;

[[noreturn]] void refuse(const Scenario& scenario, const std::string& pointer,
                         const std::string& found, const std::string& remedy) {
  throw map::InputError(
      {.file = scenario.file.string(), .place = pointer, .found = found, .remedy = remedy});
}

/// The place's own message, at its place in the scenario.
Place find(const Scenario& scenario, const map::RoadMap& road_map, const ScenarioPlace& place) {
  try {
    return find_place(road_map, place.text);
  } catch (const map::InputError& error) {
    refuse(scenario, place.pointer, error.what(), "");
  }
}

Route route_or_refuse(const Scenario& scenario, const map::RoadMap& road_map,
                      const planning::RoutePlace& from, const ScenarioPlace& to) {
  planning::RouteAnswer answer =
      planning::find_route(road_map, from, find(scenario, road_map, to).for_route());
  if (!answer.route) {
    refuse(scenario, to.pointer, "no route leads there: " + answer.reason,
           "choose another start or goal");
  }
  return *std::move(answer.route);
}

/// Where the ego goes along, and what it is a route of the map on; none of way-points.
struct Course {
  Route route;
  ReferenceLine line;
  planning::ReferenceLineOptions line_options = {};
};

Course along_route(const Scenario& scenario, const map::RoadMap& road_map, const Place& start) {
  // Without a heading the vehicle stands as its lane runs.
  const bool against = start.sense == planning::Sense::against;
  Route route = route_or_refuse(
      scenario, road_map,
      {start.on_lane, against ? planning::Sense::against : planning::Sense::along}, scenario.goal);
  planning::RouteLine drawn =
      planning::line_along(road_map, route, scenario.vehicle, scenario.options.desired_speed_mps);
  const geometry::LinePosition at = drawn.line.project(start.map_from_vehicle.position());
  const double turn_rad = drawn.line.at(at.s_m).heading_rad - start.map_from_vehicle.heading_rad;
  if (std::cos(turn_rad) <= 0.0) {
    refuse(scenario, scenario.start.pointer,
           "heads against the lane, along which the route to the goal leads",
           "turn the vehicle, or set it in the lane of its direction");
  }
  return {std::move(route), std::move(drawn.line), drawn.options};
}

/// A point need not be on the road.
Eigen::Vector2d way_point(const Scenario& scenario, const map::RoadMap& road_map,
                          const ScenarioPlace& place) {
  if (point_syntax_fault(place.text).empty()) {
    try {
      return road_map.to_map(find_point(road_map, place.text));
    } catch (const map::InputError& error) {
      refuse(scenario, place.pointer, error.what(), "");
    }
  }
  const Place found = find(scenario, road_map, place);
  if (found.has_heading) {
    refuse(scenario, place.pointer, "has a heading", "leave it out: a way-point has none");
  }
  return found.map_from_vehicle.position();
}

Course through_way_points(const Scenario& scenario, const map::RoadMap& road_map,
                          const Place& start) {
  const ScenarioWayPoints& way = *scenario.way_points;
  if (2.0 * way.half_width_m < scenario.vehicle.width_m) {
    refuse(scenario, "/half_width_m",
           fmt::format("{} m to each side, less than half the vehicle's {} m", way.half_width_m,
                       scenario.vehicle.width_m),
           "make it wider");
  }
  std::vector<Eigen::Vector2d> points = {start.map_from_vehicle.position()};
  for (const ScenarioPlace& place : way.places) {
    points.push_back(way_point(scenario, road_map, place));
  }
  const double speed_mps = std::min(way.speed_limit_mps, scenario.options.desired_speed_mps);
  try {
    ReferenceLine line =
        ReferenceLine::through(points, way.half_width_m, way.speed_limit_mps,
                               {.corner_vehicle = scenario.vehicle, .corner_speed_mps = speed_mps});
    const double turn_rad = line.at(0.0).heading_rad - start.map_from_vehicle.heading_rad;
    if (std::cos(turn_rad) <= 0.0) {
      refuse(scenario, way.places.front().pointer, "lies behind the vehicle",
             "turn the vehicle with ego.start \"X,Y,HEADING\"");
    }
    return {{}, std::move(line)};
  } catch (const std::invalid_argument& unusable) {
    refuse(scenario, "/way_points", fmt::format("make no line: {}", unusable.what()),
           "give distinct points, on a way of 75 km at most that does not turn back on itself");
  }
}

/// Makes obstacles of the scenario's; one instance per world.
class ObstacleMaker {
 public:
  ObstacleMaker(const Scenario& scenario, const map::RoadMap& road_map)
      : scenario_(scenario), road_map_(road_map), lane_ends_(planning::lane_ends(road_map)) {}

  Obstacle make(const ScenarioObstacle& from) const {
    Obstacle obstacle{.id = from.id,
                      .kind = from.kind,
                      .length_m = from.length_m,
                      .width_m = from.width_m,
                      .motion = {}};
    obstacle.motion = std::visit([&](const auto& how) { return motion(how); }, from.motion);
    if (std::holds_alternative<RecordedObstacle>(from.motion) && !obstacle.is_static()) {
      obstacle.validity = {obstacle.motion.start_s(), obstacle.motion.end_s()};
    }
    return obstacle;
  }

  // Its speeds follow from its poses.
  Obstacle make(const planning::ObstacleInSource& from) const {
    Obstacle obstacle = planning::obstacle_in_map(road_map_, from);
    std::vector<TimedPose> poses;
    for (const geometry::TrajectoryPoint& at : obstacle.motion.points()) {
      poses.push_back({at.t_s, at.pose()});
    }
    obstacle.motion = drive_through(poses);
    return obstacle;
  }

  LaneDriver driver_of(const std::string& id, const TrafficObstacle& traffic) const {
    const map::LanePlace start = find(scenario_, road_map_, traffic.start).on_lane;
    LaneDriver driver = traffic.to ? along_route(traffic, start) : along_lanes(traffic, start);
    driver.obstacle = id;
    driver.lane_ends = lane_ends_beside(driver);
    return driver;
  }

 private:
  Pose2 to_map(const Pose2& in_source) const {
    const Eigen::Vector2d place = road_map_.to_map(in_source.position());
    return {place.x(), place.y(), in_source.heading_rad};
  }

  Pose2 pose_of(const Pose2& in_source) const { return to_map(in_source); }

  Pose2 pose_of(const ParkedObstacle::Beside& beside) const {
    const Pose2 on_lane = find(scenario_, road_map_, beside.place).map_from_vehicle;
    return on_lane * Pose2{0.0, beside.d_m, 0.0};
  }

  geometry::Trajectory motion(const ParkedObstacle& parked) const {
    const Pose2 pose = std::visit([&](const auto& at) { return pose_of(at); }, parked.at);
    return drive_through({{0.0, pose}});
  }

  geometry::Trajectory motion(const ScriptedObstacle& scripted) const {
    std::vector<TimedPose> poses = scripted.poses;
    for (TimedPose& timed : poses) timed.pose = to_map(timed.pose);
    return drive_through(poses);
  }

  geometry::Trajectory motion(const RecordedObstacle& recorded) const {
    std::vector<geometry::TrajectoryPoint> rows = motion_of(recorded).points();
    const double from_s = rows.front().t_s, to_s = rows.back().t_s;
    if (rows.size() > 1 && (from_s > scenario_.duration_s || to_s < 0.0)) {
      refuse(scenario_, recorded.pointer,
             fmt::format("is there from {} s to {} s, and the scenario lasts {} s", from_s, to_s,
                         scenario_.duration_s),
             "shift its times by offset_s");
    }
    for (geometry::TrajectoryPoint& row : rows) {
      const Eigen::Vector2d place = road_map_.to_map(row.pose().position());
      row.x_m = place.x();
      row.y_m = place.y();
    }
    return geometry::Trajectory(std::move(rows));
  }

  geometry::Trajectory motion(const TrafficObstacle& traffic) const {
    const LaneDriver driver = driver_of({}, traffic);
    return drive_along(driver.way, driver.way_length_m, driver.speeds, known_s());
  }

  LaneDriver along_lanes(const TrafficObstacle& traffic, const map::LanePlace& start) const {
    const double length_m = travelled_m(traffic.speeds, known_s()) + 1.0;
    const geometry::Polyline way = planning::straight_on(road_map_, start, length_m);
    return {.obstacle = {},
            .way = [way](double distance_m) { return way.pose_at(distance_m); },
            .way_length_m = way.length_m(),
            .place_of = [way](const Eigen::Vector2d& point) { return way.project(point); },
            .speeds = traffic.speeds};
  }

  LaneDriver along_route(const TrafficObstacle& traffic, const map::LanePlace& start) const {
    const Route route =
        route_or_refuse(scenario_, road_map_, {start, planning::Sense::along}, *traffic.to);
    const ReferenceLine line = ReferenceLine::along(road_map_, route);
    const auto pose_at = [line](double s_m) {
      const planning::ReferencePoint point = line.at(s_m);
      return Pose2{point.in_map.x(), point.in_map.y(), point.heading_rad};
    };
    return {.obstacle = {},
            .way = pose_at,
            .way_length_m = line.goal_s_m(),
            .place_of = [line](const Eigen::Vector2d& point) { return line.project(point); },
            .speeds = traffic.speeds};
  }

  /// Up to two lanes' width away.
  std::vector<LaneEndBeside> lane_ends_beside(const LaneDriver& driver) const {
    constexpr double kLeast_m = 1.5, kMost_m = 6.0, kAlong = 0.8;
    std::vector<LaneEndBeside> beside;
    for (std::size_t i = 0; i < lane_ends_.size(); ++i) {
      const geometry::LinePosition at = driver.place_of(lane_ends_[i].position());
      const Pose2 foot = driver.way(at.s_m);
      const double away_m = (foot.position() - lane_ends_[i].position()).norm();
      const bool is_along = std::cos(foot.heading_rad - lane_ends_[i].heading_rad) > kAlong;
      if (is_along && away_m > kLeast_m && away_m < kMost_m) beside.push_back({i, at});
    }
    return beside;
  }

  double known_s() const { return scenario_.duration_s + TrafficFlow::kForeseenFor_s; }

  const Scenario& scenario_;
  const map::RoadMap& road_map_;
  std::vector<Pose2> lane_ends_;
};

/// A light that the map does not have would never be seen.
void refuse_unknown_signals(const Scenario& scenario, const map::RoadMap& road_map) {
  for (const planning::LightCycle& light : scenario.lights) {
    for (const std::string& id : light.signals) {
      const bool known = std::ranges::any_of(
          road_map.signals(), [&](const map::Signal& signal) { return signal.source_id == id; });
      if (known) continue;
      refuse(scenario, light.pointer + "/signals",
             fmt::format("no signal \"{}\" is in the map", id), "name one of the map's signals");
    }
  }
}

/// The boxes of the scenario's obstacles_file, behind its own obstacles.
void add_boxes(const Scenario& scenario, const ObstacleMaker& maker,
               std::vector<Obstacle>& obstacles) {
  const std::filesystem::path& file = scenario.obstacles_file;
  for (const auto& box : parse_obstacles_csv(map::read_file(file, map::most_unpacked_of_rows),
                                             map::input_name(file))) {
    const auto same = [&](const ScenarioObstacle& own) { return own.id == box.id; };
    if (std::ranges::any_of(scenario.obstacles, same)) {
      refuse(scenario, "/obstacles_file",
             fmt::format("names \"{}\", as an obstacle of the scenario", box.id),
             "rename one of the two");
    }
    obstacles.push_back(maker.make(box));
  }
}

/// @pre the obstacles are those of the scenario, in its order, then those of its file.
void refuse_overlap(const Scenario& scenario, const World& world) {
  const geometry::Rectangle body = geometry::body_at(world.start, scenario.vehicle);
  for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
    const Obstacle& obstacle = world.obstacles[i];
    if (!obstacle.is_there(0.0)) continue;
    if (geometry::distance_m(body, rectangle_at(obstacle, 0.0)) > 0.0) continue;
    refuse(scenario,
           i < scenario.obstacles.size() ? fmt::format("/obstacles/{}", i) : "/obstacles_file",
           fmt::format("{} touches the ego at the start", obstacle.id), "move one of the two");
  }
}

}  // namespace

World make_world(const Scenario& scenario, const Inputs& inputs) {
  auto kept_map = inputs.road_map(scenario.map_file);
  const map::RoadMap& road_map = *kept_map;
  const Place start = find(scenario, road_map, scenario.start);
  Course course = scenario.way_points ? through_way_points(scenario, road_map, start)
                                      : along_route(scenario, road_map, start);
  const ObstacleMaker maker(scenario, road_map);
  std::vector<Obstacle> obstacles;
  std::vector<LaneDriver> drivers;
  for (const ScenarioObstacle& obstacle : scenario.obstacles) {
    obstacles.push_back(maker.make(obstacle));
    if (const auto* traffic = std::get_if<TrafficObstacle>(&obstacle.motion)) {
      drivers.push_back(maker.driver_of(obstacle.id, *traffic));
    }
  }
  if (!scenario.obstacles_file.empty()) add_boxes(scenario, maker, obstacles);
  planning::refuse_endless_ways(std::span<const Obstacle>(obstacles),
                                map::input_name(scenario.file));
  std::shared_ptr<const map::OccupancyMap> occupancy;
  std::shared_ptr<const map::ClearanceField> field;
  if (!scenario.occupancy_files.empty()) {
    occupancy = inputs.occupancy_of(scenario.occupancy_files);
    field = inputs.field_of(scenario.occupancy_files, scenario.vehicle.height_m);
  }
  refuse_unknown_signals(scenario, road_map);
  std::vector<planning::StopPoint> places =
      planning::stop_points(road_map, course.route, course.line, scenario.lights);
  planning::OtherLevels other_levels(road_map, course.route);
  World world{{.kept_map = std::move(kept_map),
               .field = std::move(field),
               .start = start.map_from_vehicle,
               .route = std::move(course.route),
               .line = std::move(course.line),
               .line_options = course.line_options,
               .other_levels = std::move(other_levels),
               .obstacles = std::move(obstacles),
               .lights = scenario.lights,
               .stop_points = std::move(places)},
              std::move(occupancy),
              std::move(drivers)};
  world.other_levels.leave_out(world.start, 0.0, world.obstacles);
  refuse_overlap(scenario, world);
  return world;
}

}  // namespace roadbed::tools::simulation
