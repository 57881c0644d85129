#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/planning/task/driving_task.h"
#include "roadbed/planning/tracking/motion_filter.h"
#include "roadbed/tools/simulation/planner_options.h"
#include "roadbed/tools/simulation/recorded_obstacle.h"

namespace roadbed::tools::inline simulation {

// A scenario file, as it is written: places are still texts and coordinates the source's raw ones.
// The schema is in tools/simulation/README.md. make_world() turns it into what is driven.

/// A place given on the map, and how it was called in the file, for messages.
struct ScenarioPlace {
  std::string text;     ///< as tools/cli/place.h tells
  std::string pointer;  ///< JSON pointer of the text
};

/// A way of its own in place of a route, from the ego's start through all of them.
struct ScenarioWayPoints {
  std::vector<ScenarioPlace> places;  ///< at least one; the last one is the goal
  double half_width_m = 1.75;         ///< room on both sides of the line
  double speed_limit_mps = 50.0 / 3.6;
};

/// Stands for the whole scenario.
struct ParkedObstacle {
  /// Pose of its centre in source coordinates, or a place on a lane with an offset to the left.
  struct Beside {
    ScenarioPlace place;
    double d_m = 0.0;
  };
  std::variant<geometry::Pose2, Beside> at;
};

/// Pose of an obstacle's centre at a time, in source coordinates.
struct TimedPose {
  double t_s = 0.0;
  geometry::Pose2 pose;
};

/// Moves as written; linear between the poses, resting before the first and after the last.
struct ScriptedObstacle {
  std::vector<TimedPose> poses;  ///< at least one, times increase
};

struct TimedSpeed {
  double t_s = 0.0;
  double speed_mps = 0.0;
};

/// Drives along the centres of lanes: along a route, or always straight on.
struct TrafficObstacle {
  ScenarioPlace start;
  std::optional<ScenarioPlace> to;
  std::vector<TimedSpeed> speeds;  ///< at least one, times increase; linear between
};

struct ScenarioObstacle {
  std::string id;  ///< unique
  std::string kind = "car";
  double length_m = 4.5;
  double width_m = 1.8;
  std::variant<ParkedObstacle, ScriptedObstacle, TrafficObstacle, RecordedObstacle> motion;
};

/// Standard deviations of what is measured; white and Gaussian.
struct ScenarioNoise {
  double gap_m = 0.0;
  double relative_speed_mps = 0.0;
  double acceleration_mps2 = 0.0;
  double position_m = 0.0;  ///< of each coordinate
  double heading_rad = 0.0;
  double speed_mps = 0.0;
  planning::ObjectNoise object = {.position_m = 0.0, .heading_rad = 0.0, .speed_mps = 0.0};
  double object_range_m = 1000.0;                 ///< farther away nobody is measured
  std::vector<planning::TimeSpan> dropouts = {};  ///< in which nothing is measured of others
  double dropout_ratio = 0.0;  ///< of the other measurements of others, lost at random

  /// Whether others are measured otherwise than they are.
  bool is_of_others() const {
    return object.position_m > 0.0 || object.heading_rad > 0.0 || object.speed_mps > 0.0 ||
           dropout_ratio > 0.0;
  }
};

struct Scenario {
  std::filesystem::path file;
  std::string name;
  std::filesystem::path map_file;                      ///< resolved against the scenario's folder
  std::vector<std::filesystem::path> occupancy_files;  ///< the same; empty: no occupancy
  ScenarioPlace start, goal;
  std::optional<ScenarioWayPoints> way_points;  ///< in place of the goal
  double start_speed_mps = 0.0;
  geometry::VehicleShape vehicle;
  std::filesystem::path vehicle_file;  ///< that it is read from, resolved; empty: it names measures
  double duration_s = 60.0;
  std::uint64_t seed = 1;
  ScenarioNoise noise;
  planning::DrivingOptions options;
  bool pedals = true;  ///< acceleration goes through throttle and brake, air, tyres and grade
  std::vector<planning::LightCycle> lights;
  std::vector<ScenarioObstacle> obstacles;
  std::filesystem::path obstacles_file;  ///< boxes over time besides, resolved; empty: none
};

/// Reads and checks a scenario; of the files that it names only a vehicle's is opened.
/// @throws InputError naming the file and the JSON pointer of the first fault.
Scenario read_scenario(const std::filesystem::path& file);

/// The same from bytes; `file` stands for the scenario in messages and gives the folder. No file is
/// opened: a vehicle's is left to the caller.
Scenario parse_scenario(std::string_view bytes, const std::filesystem::path& file);

/// The map, the clouds, the files of vehicle and obstacles, and the recorded drives that a scenario
/// names, or those of all scenarios (.json) right in a folder. A file that is no such scenario
/// names none, as a CommonRoad one, which holds its map.
std::vector<std::filesystem::path> files_named_by_scenario(const std::filesystem::path& file);

/// What a scenario is driven with otherwise than its file says.
struct ScenarioChanges {
  std::optional<geometry::VehicleShape> vehicle = {};
  std::optional<ScenarioNoise> noise = {};
  std::optional<std::uint64_t> seed = {};
  bool drops_ego_recording = false;  ///< of a CommonRoad file, see common_road_obstacles.h
  PlannerChanges planner = {};

  /// @throws InputError if there is a seed, and nothing that is left to chance: all seeds would
  ///         give the same drive.
  void apply_to(Scenario& scenario) const;
};

/// A seed as the command line has it: a whole number from 0 to 2⁵³, as in scenario files; none for
/// any other text.
std::optional<std::uint64_t> parse_seed(std::string_view text);

/// The same as a JSON number.
/// @throws InputError naming its place.
std::uint64_t seed_in(const JsonNode& node);

/// What a light shows: "green", "yellow" or "red".
/// @throws InputError naming its place.
planning::LightColour light_colour_in(const JsonNode& node);

/// Reads noise: one JSON object with the keys of a scenario's `noise`.
/// @throws InputError naming the key, or the byte where the text is not JSON.
ScenarioNoise read_noise_json(const std::filesystem::path& file);

}  // namespace roadbed::tools::simulation
