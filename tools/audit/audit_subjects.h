#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/tools/audit/argoverse_log.h"
#include "roadbed/tools/cli/arguments.h"
#include "roadbed/tools/cli/drive_arguments.h"
#include "roadbed/tools/cli/inputs.h"
#include "roadbed/tools/cli/route_question.h"
#include "roadbed/tools/files/drive_file.h"

namespace roadbed::tools::inline audit {

/// A drive to audit: a file, or what was made by sweeping a line.
struct AuditSubject {
  std::string name;                 ///< of the file, within its folder where that was given
  std::filesystem::path file = {};  ///< empty: swept
  geometry::Trajectory swept = {};
  DriveOptions options = {};  ///< of the file

  /// @throws InputError if the file is unusable.
  DriveOfFile read() const;
};

/// The options that say what is audited: `--trajectory` (a file or a folder), `--log`, or a route
/// or lane of the map, swept: `--from --to` with the rules of routes, `--lane`, `--speed --offset`.
class AuditSubjects {
 public:
  /// @returns what says how a drive is found, swept or read, which certificates are not about.
  std::vector<Argument> declare(Arguments& arguments);

  /// What is wrong with the options together; empty if nothing is.
  std::string fault(bool has_map) const;

  /// Whether a start, a goal or a place between is given.
  bool has_any_place() const { return question_.has_any_place(); }
  bool is_swept() const { return file().empty(); }

  /// The file or folder that was given, or is the drive of the log; may be empty.
  std::filesystem::path file() const;

  /// The folder of a log of Argoverse 2, of which more than its drive counts; may be empty.
  const std::filesystem::path& log() const { return log_; }
  /// Where the boxes of that log come from.
  LogBoxes log_boxes() const { return boxes_; }

  /// All files that end in .csv in the folder, and the trajectory.csv of folders below it, by name;
  /// one subject otherwise.
  /// @param road_map  null unless it is swept.
  /// @param shape     of the vehicle, for poses of its centre.
  /// @throws InputError if the folder holds none, or there is no such route or lane.
  std::vector<AuditSubject> list(const map::RoadMap* road_map,
                                 const geometry::VehicleShape& shape) const;

  /// Whether a folder was given, whose drives are listed in a table; a bag's is one drive.
  bool is_folder() const;

 private:
  std::vector<AuditSubject> in_folder() const;
  AuditSubject route(const map::RoadMap& road_map) const;
  AuditSubject lane(const map::RoadMap& road_map) const;
  std::string suffix() const;

  std::filesystem::path trajectory_, log_;
  LogBoxes boxes_ = LogBoxes::found;
  std::optional<Argument> boxes_argument_;
  DriveArguments of_drive_;
  RouteQuestion question_;
  std::string lane_;
  double speed_kmh_ = 30.0, offset_m_ = 0.0;
};

/// Obstacles over time, in source coordinates: of a scenario (`.json`, or CommonRoad `.xml`, see
/// `recorded_boxes`), or boxes with time stamps (`.csv`).
/// @param start_step  of CommonRoad, that is second 0 (`second_0_step`); none: that of the planning
///                    problem in the file itself, else 0.
/// @throws InputError if the file, or one that it names, is unusable.
std::vector<planning::ObstacleInSource> read_moving_obstacles(const std::filesystem::path& file,
                                                              const Inputs& inputs,
                                                              std::optional<long> start_step = {});

}  // namespace roadbed::tools::audit
