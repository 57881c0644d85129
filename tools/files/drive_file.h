#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/tools/files/drive_options.h"

namespace roadbed::tools::inline files {

/// A time of a drive.
struct DriveGap {
  double from_s, to_s;
};

/// A drive as a file holds it.
struct DriveOfFile {
  geometry::Trajectory drive;
  std::vector<std::string> notes = {};  ///< for users: poses left out, gaps, jumps
  std::vector<DriveGap> gaps = {};      ///< in which its log has no pose, in order of time
  bool is_planned = false;              ///< its times are not those of measurements
};

/// Lines for users, "note: NAME: …".
std::string notes_text(const std::string& name, const std::vector<std::string>& notes);

/// Reads a drive, its format told by content:
///
/// | format | poses, where not said otherwise | times |
/// |---|---|---|
/// | CSV, as trajectory_csv.h | rear axle, always | as they stand |
/// | log: rosbag2, MCAP (map/logs) | rear axle | from the first pose on |
/// | MCAP that roadbed wrote | rear axle, always | as they stand |
/// | Argoverse 2, `city_SE3_egovehicle.feather` | rear axle | from the first pose on |
/// | CommonRoad solution (KS, ST, MB, PM) | middle of its vehicle's body | steps; `rate_hz` |
/// | TUM: `t x y z qx qy qz qw` a line | has to be said | as they stand |
/// | KITTI: the upper three rows of the matrix | has to be said | `rate_hz` |
///
/// z points up in all of them, but ahead where `--pose-frame camera` says that they are a camera's:
/// a pose (x, y, z) of one is then at (z, -x), headed as its z axis is. One of which more than 0.9
/// of the way, over 5 m, is along z, is refused where that was not said. Between poses of a log
/// that are more than 5 median intervals and 0.5 s apart nobody knows where the vehicle was: a gap.
/// Notes say that, and steps of over 60 m/s. Speeds follow from the poses where the file has none.
/// @throws InputError with file and place; also where rows cannot be a drive (`implausible_row`).
DriveOfFile read_drive(const std::filesystem::path& file, const DriveOptions& options);

/// The same of the bytes of one file; `name` stands for it in messages.
geometry::Trajectory parse_drive(std::string_view bytes, const std::string& name,
                                 const DriveOptions& options);

/// Whether a drive is a CommonRoad solution; a folder is none.
bool is_solution(const std::filesystem::path& file);

/// The vehicle that a solution names, as `--vehicle` takes it: "commonroad:3".
/// @pre is_solution(file)
/// @throws InputError if it names none.
std::string vehicle_of_solution(const std::filesystem::path& file);

/// Whether a drive is a table as `write_trajectory_csv` writes it, which needs no options.
bool is_drive_table(const std::filesystem::path& file);

}  // namespace roadbed::tools::files
