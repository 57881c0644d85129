#include "roadbed/tools/audit/audit_subjects.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/logs/log.h"
#include "roadbed/planning/audit/swept_drive.h"
#include "roadbed/planning/obstacles/obstacle_limits.h"
#include "roadbed/planning/obstacles/recorded_obstacles.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tools/cli/place.h"
#include "roadbed/tools/files/obstacles_csv.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline audit {
namespace {

namespace fs = std::filesystem;
using geometry::Pose2;

constexpr double kShortestSweep_m = 0.01;
constexpr double kLongestSweep_m = planning::kMostSupportPoints * 0.5;  // as a route's line

Pose2 in_source(const map::RoadMap& road_map, const Pose2& in_map) {
  const Eigen::Vector2d place = road_map.to_source(in_map.position());
  return {place.x(), place.y(), in_map.heading_rad};
}

[[noreturn]] void refuse_subject(const std::string& subject, const std::string& found,
                                 const std::string& needed, const std::string& remedy) {
  throw map::InputError({.file = subject, .found = found, .needed = needed, .remedy = remedy});
}

bool is_drive(const fs::path& file, const fs::path& folder) {
  if (file.filename() == "trajectory.csv") return true;
  return file.extension() == ".csv" && file.parent_path() == folder;
}

using planning::ObstacleInSource;

std::vector<ObstacleInSource> of_scenario(const std::filesystem::path& file, const Inputs& inputs) {
  const World world = make_world(read_scenario(file), inputs);
  std::vector<ObstacleInSource> obstacles;
  for (const planning::Obstacle& obstacle : world.obstacles) {
    obstacles.push_back(planning::obstacle_in_source(world.road_map, obstacle));
  }
  return obstacles;
}

}  // namespace

DriveOfFile AuditSubject::read() const {
  return file.empty() ? DriveOfFile{.drive = swept} : read_drive(file, options);
}

std::vector<Argument> AuditSubjects::declare(Arguments& arguments) {
  arguments.heading("Drives");
  Argument trajectory =
      arguments
          .add("--trajectory", trajectory_,
               "Drive to audit, linear between its rows; every point of the body is covered: .csv "
               "with "
               "poses of the rear axle, a log (rosbag2, MCAP), a CommonRoad solution, poses of "
               "Argoverse 2, TUM or KITTI. Or a folder: its .csv files, and each trajectory.csv "
               "below")
          .reads();
  Argument log =
      arguments
          .add("--log", log_,
               "Folder of a sensor log of Argoverse 2: its ego's drive, with --map the log's map, "
               "--on drivable, and hits and boxes of its sweeps, where these are not given")
          .reads();
  boxes_argument_ = arguments.choice(
      "--boxes", boxes_, {{"found", LogBoxes::found}, {"annotated", LogBoxes::annotated}},
      "Of --log: dynamic obstacles are what is found in its sweeps and followed (as occupancy "
      "objects does), or the boxes that people have annotated");
  const std::vector<Argument> of_files = of_drive_.declare(arguments);
  std::vector<Argument> of_sweeps = question_.declare(arguments, true);
  Argument lane = arguments.add(
      "--lane", lane_, "Audit a lane of --map from its start, or S, to its end: lane:NAME[@S]");
  for (const Argument& rule : of_sweeps) lane.excludes(rule);  // they are about finding a route
  lane.checked([](const std::string& text) {
    return text.starts_with("lane:") ? place_syntax_fault(text) : "is not lane:NAME[@S]";
  });
  of_sweeps.push_back(
      arguments.add("--speed", speed_kmh_, "Of a drive along a route or lane [km/h]")
          .within(0.1, 1000.0)
          .with_default());
  of_sweeps.push_back(
      arguments
          .add("--offset", offset_m_,
               "Of the rear axle from the route's line or the lane's centre, to the left [m]")
          .within(-1000.0, 1000.0)
          .with_default());
  for (const Argument& other : of_sweeps) {
    trajectory.excludes(other);
    log.excludes(other);
    for (Argument rule : of_files) rule.excludes(other);
  }
  std::vector<Argument> declared = of_sweeps;
  declared.insert(declared.end(), of_files.begin(), of_files.end());
  declared.insert(declared.end(), {*boxes_argument_, lane});
  return declared;
}

std::string AuditSubjects::fault(bool has_map) const {
  const bool has_file = !trajectory_.empty(), has_log = !log_.empty(), has_lane = !lane_.empty();
  if (has_file + has_log + has_lane + question_.has_any_place() != 1) {
    return "needs just one of --trajectory, --log, --lane, and --from with --to";
  }
  if (boxes_argument_->given() && !has_log) return "--boxes needs --log";
  if (has_file || has_log) return {};
  if (!has_lane && !question_.has_places()) return "--from and --to are required";
  return has_map ? "" : "--map is required";
}

fs::path AuditSubjects::file() const {
  return log_.empty() ? trajectory_ : drive_of_argoverse_log(log_);
}

bool AuditSubjects::is_folder() const {
  return log_.empty() && map::is_folder(trajectory_) && !map::is_log(trajectory_);
}

std::vector<AuditSubject> AuditSubjects::list(const map::RoadMap* road_map,
                                              const geometry::VehicleShape& shape) const {
  if (is_folder()) return in_folder();
  if (!is_swept()) {
    return {{.name = map::one_line(file().string()),
             .file = file(),
             .options = of_drive_.options(shape)}};
  }
  return {lane_.empty() ? route(*road_map) : lane(*road_map)};
}

std::vector<AuditSubject> AuditSubjects::in_folder() const {
  std::vector<AuditSubject> subjects;
  std::error_code unreadable;
  for (const auto& entry : fs::recursive_directory_iterator(
           trajectory_, fs::directory_options::skip_permission_denied, unreadable)) {
    if (!entry.is_regular_file(unreadable) || !is_drive(entry.path(), trajectory_)) continue;
    subjects.push_back(
        {.name = map::one_line(entry.path().lexically_relative(trajectory_).string()),
         .file = entry.path()});
  }
  if (subjects.empty()) {
    refuse_subject(trajectory_.string(), "no drive",
                   "files that end in .csv, or folders with a trajectory.csv",
                   "give another folder");
  }
  std::ranges::sort(subjects, {}, &AuditSubject::name);
  return subjects;
}

std::string AuditSubjects::suffix() const {
  return offset_m_ == 0.0 ? "" : fmt::format(", {} m to the left", offset_m_);
}

AuditSubject AuditSubjects::route(const map::RoadMap& road_map) const {
  const RouteQuestion::Asked asked = question_.on(road_map);
  const planning::RouteAnswer answer =
      planning::Router(road_map, asked.options).find(asked.places());
  if (!answer.route) refuse_subject("route", answer.reason, "", "choose another start or goal");
  const auto line = planning::ReferenceLine::along(road_map, *answer.route);
  const double length_m = line.goal_s_m();
  if (!(length_m > kShortestSweep_m)) {
    refuse_subject("route", fmt::format("is {} m long", length_m), "a way to drive",
                   "choose a goal ahead of the start");
  }
  const auto pose_at = [&](double s_m) {
    const planning::ReferencePoint point = line.at(s_m);
    return in_source(road_map, {point.in_map.x(), point.in_map.y(), point.heading_rad});
  };
  return {.name = fmt::format("route of {:.1f} m{}", length_m, suffix()),
          .swept = planning::swept_along(pose_at, length_m,
                                         {.speed_mps = speed_kmh_ / 3.6, .offset_m = offset_m_})};
}

AuditSubject AuditSubjects::lane(const map::RoadMap& road_map) const {
  const map::LanePlace from = find_place(road_map, lane_, question_.rules().participant()).on_lane;
  const map::Lane& lane = road_map.lane(from.lane);
  const double length_m = lane.length_m() - from.s_m;
  if (!(length_m > kShortestSweep_m)) {
    refuse_subject(lane_, fmt::format("is {} m before the lane's end", length_m),
                   "a part of the lane", "choose a lower S");
  }
  if (length_m > kLongestSweep_m) {
    refuse_subject(lane_, fmt::format("leaves {:.0f} m of the lane", length_m),
                   fmt::format("at most {:.0f} m", kLongestSweep_m),
                   "audit a route along it, in parts");
  }
  const auto pose_at = [&](double s_m) {
    return in_source(road_map, lane.pose_at(from.s_m + s_m));
  };
  return {.name = fmt::format("lane {}{}", lane.name, suffix()),
          .swept = planning::swept_along(pose_at, length_m,
                                         {.speed_mps = speed_kmh_ / 3.6, .offset_m = offset_m_})};
}

std::vector<ObstacleInSource> read_moving_obstacles(const std::filesystem::path& file,
                                                    const Inputs& inputs,
                                                    std::optional<long> start_step) {
  if (is_common_road(file)) {
    const std::string name = map::input_name(file);
    const map::commonroad::Scenario scenario =
        map::commonroad::parse_scenario(map::read_file(file), name);
    const std::vector<ObstacleInSource> boxes = planning::recorded_boxes(
        scenario, start_step.value_or(planning::initial_step(scenario).value_or(0)), name);
    planning::refuse_endless_ways(std::span(boxes), name);
    return boxes;
  }
  const std::string start = map::read_file_start(file, 4096);
  const std::size_t sign = start.find_first_not_of(" \t\r\n");
  if (sign != std::string::npos && start[sign] == '{') return of_scenario(file, inputs);
  return parse_obstacles_csv(map::read_file(file, map::most_unpacked_of_rows),
                             map::input_name(file));
}

}  // namespace roadbed::tools::audit
