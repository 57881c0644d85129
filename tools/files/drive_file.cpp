#include "roadbed/tools/files/drive_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/logs/feather.h"
#include "roadbed/map/logs/log.h"
#include "roadbed/map/logs/log_contents.h"
#include "roadbed/map/logs/log_drive.h"
#include "roadbed/tools/files/drive_formats.h"
#include "roadbed/tools/files/trajectory_csv.h"

namespace roadbed::tools::inline files {
namespace {

namespace fs = std::filesystem;
using geometry::Pose2;
using geometry::TrajectoryPoint;

constexpr std::size_t kStart = 4096;  // of a file, by which its format is told

/// A format of drives that are no tables: how it begins, and who reads it.
struct DriveFormat {
  bool (*begins)(std::string_view bytes);
  DrivePoses (*parse)(std::string_view bytes, const std::string& name, const DriveOptions& options);
};

constexpr DriveFormat kFormats[] = {
    {map::is_feather, parse_argoverse_poses},
    {begins_as_solution, parse_solution},
    {begins_as_pose_lines, parse_pose_lines},
};

const DriveFormat* format_of(std::string_view bytes) {
  for (const DriveFormat& format : kFormats) {
    if (format.begins(bytes)) return &format;
  }
  return nullptr;
}

TrajectoryPoint rear_axle(const DrivePose& pose, const Pose2& pose_in_vehicle) {
  const double heading_rad = pose.heading_rad - pose_in_vehicle.heading_rad;
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  return {.t_s = pose.t_s,
          .x_m = pose.x_m - (c * pose_in_vehicle.x_m - s * pose_in_vehicle.y_m),
          .y_m = pose.y_m - (s * pose_in_vehicle.x_m + c * pose_in_vehicle.y_m),
          .heading_rad = heading_rad,
          .speed_mps = pose.speed_mps.value_or(0.0)};
}

class DriveOfPoses {
 public:
  DriveOfPoses(const DrivePoses& read, const std::string& name) : read_(read), name_(name) {}

  geometry::Trajectory drive(const Pose2& pose_in_vehicle) const {
    if (read_.poses.empty()) refuse(0, "", "holds no pose", "at least one", "give another file");
    std::vector<TrajectoryPoint> rows;
    for (const DrivePose& pose : read_.poses) {
      check(pose, rows);
      rows.push_back(rear_axle(pose, pose_in_vehicle));
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!read_.poses[i].speed_mps) rows[i].speed_mps = speed_of_way_mps(rows, i);
    }
    if (const auto fault = read_.has_rotations ? impossible_step(rows) : implausible_row(rows)) {
      refuse(fault->row, "", fault->found, fault->needed, fault->remedy);
    }
    return geometry::Trajectory(std::move(rows));
  }

 private:
  [[noreturn]] void refuse(std::size_t i, const std::string& element, const std::string& found,
                           const std::string& needed, const std::string& remedy) const {
    std::string place;
    if (i < read_.places.size()) {
      place = std::to_string(read_.places[i]);
      if (read_.unit != "line") place = read_.unit + " " + place;
    }
    throw map::InputError({.file = name_,
                           .place = place,
                           .element = element,
                           .found = found,
                           .needed = needed,
                           .remedy = remedy});
  }

  void check(const DrivePose& pose, const std::vector<TrajectoryPoint>& before) const {
    constexpr double earth_m = 1e9;
    const std::size_t i = before.size();
    const double sum = pose.t_s + pose.heading_rad + pose.speed_mps.value_or(0.0);
    if (!std::isfinite(sum) || !(std::abs(pose.x_m) < earth_m && std::abs(pose.y_m) < earth_m)) {
      refuse(i, "", fmt::format("is at {}, {} at {} s", pose.x_m, pose.y_m, pose.t_s),
             "a place on Earth at a time", "remove the pose");
    }
    if (i > 0 && !(pose.t_s > before.back().t_s)) {
      refuse(i, "time", fmt::format("{} s does not come after {} s", pose.t_s, before.back().t_s),
             "increasing times", "sort the poses and remove doubles");
    }
  }

  const DrivePoses& read_;
  const std::string& name_;
};

/// No road does: it is a camera's z axis.
bool goes_upwards(const std::vector<DrivePose>& poses) {
  constexpr double least_way_m = 5.0, most_upwards = 0.9;
  double way_m = 0.0, upwards_m = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const DrivePose &from = poses[i - 1], &to = poses[i];
    const double up_m = std::abs(to.z_m - from.z_m);
    way_m += std::hypot(to.x_m - from.x_m, to.y_m - from.y_m, up_m);
    upwards_m += up_m;
  }
  return way_m > least_way_m && upwards_m > most_upwards * way_m;
}

DrivePoses of_log(const map::LogDrive& log, const DriveOptions& options) {
  DrivePoses read{.unit = "pose", .pose_in_vehicle = Pose2{}, .has_rotations = true};
  for (const map::TimedPose& at : log.poses) {
    const std::int64_t since_ns = at.stamp_ns - log.poses.front().stamp_ns;
    read.poses.push_back(flat_pose(1e-9 * static_cast<double>(since_ns), at.pose, options));
    read.poses.back().speed_mps = at.speed_mps;
    read.places.push_back(read.poses.size());
  }
  return read;
}

/// Rows of roadbed's own: of the rear axle, with all that they say.
geometry::Trajectory drive_of_rows(const std::vector<TrajectoryPoint>& rows,
                                   const std::string& name) {
  DrivePoses read{.unit = "row"};
  for (const TrajectoryPoint& row : rows) {
    read.poses.push_back({row.t_s, row.x_m, row.y_m, row.heading_rad, row.speed_mps});
    read.places.push_back(read.poses.size());
  }
  DriveOfPoses(read, name).drive({});  // refuses what is no drive
  return geometry::Trajectory(rows);
}

geometry::Trajectory drive_of(const DrivePoses& read, const std::string& name,
                              const DriveOptions& options) {
  const std::optional<Pose2> pose_in_vehicle =
      options.pose_frame ? options.pose_frame->pose_in_vehicle : read.pose_in_vehicle;
  if (!pose_in_vehicle) {
    throw map::InputError({.file = name,
                           .found = "does not say which point of the vehicle its poses are",
                           .needed = std::string("--pose-frame ") + kPoseFrameSyntax,
                           .remedy = "give it"});
  }
  if (!is_of_camera(options) && goes_upwards(read.poses)) {
    throw map::InputError({.file = name,
                           .found = "goes along the z axis, which is up, or is ahead of a camera",
                           .needed = "poses of a vehicle, z up, or --pose-frame camera",
                           .remedy = "give that if they are a camera's, as KITTI's are"});
  }
  return DriveOfPoses(read, name).drive(*pose_in_vehicle);
}

/// Between poses that were measured.
std::vector<DriveGap> gaps_between(const std::vector<map::TimedPose>& poses) {
  constexpr std::int64_t least_ns = 500'000'000, most_medians = 5;
  std::vector<std::int64_t> times_ns;
  for (const map::TimedPose& pose : poses) times_ns.push_back(pose.stamp_ns);
  std::int64_t median_ns = 0;
  std::vector<DriveGap> gaps;
  for (const map::LogGap& gap : map::gaps_in(times_ns, median_ns)) {
    const std::int64_t long_ns = gap.to_ns - gap.from_ns;
    if (long_ns <= least_ns || long_ns / most_medians <= median_ns) continue;
    const auto since_start_s = [&](std::int64_t at_ns) {
      return 1e-9 * static_cast<double>(at_ns - times_ns.front());
    };
    gaps.push_back({since_start_s(gap.from_ns), since_start_s(gap.to_ns)});
  }
  return gaps;
}

std::string gaps_note(const std::vector<DriveGap>& gaps) {
  const auto length_s = [](const DriveGap& gap) { return gap.to_s - gap.from_s; };
  const DriveGap& longest = *std::ranges::max_element(gaps, {}, length_s);
  return fmt::format(
      "{} gap{} between poses, {} {:.3f} s after {:.3f} s: the drive is a straight line there, "
      "which nobody measured",
      gaps.size(), gaps.size() == 1 ? "" : "s", gaps.size() == 1 ? "of" : "the longest of",
      length_s(longest), longest.from_s);
}

/// Steps that no car makes, at noise of 0.1 m.
std::string jumps_note(const std::vector<TrajectoryPoint>& rows) {
  constexpr double fastest_mps = 60.0, noise_m = 0.1;
  std::string first;
  std::size_t count = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double took_s = rows[i].t_s - rows[i - 1].t_s;
    const double way_m = std::hypot(rows[i].x_m - rows[i - 1].x_m, rows[i].y_m - rows[i - 1].y_m);
    if (way_m <= fastest_mps * took_s + noise_m) continue;
    if (++count == 1)
      first = fmt::format("{:.3f} m in {:.3g} s at {:.3f} s", way_m, took_s, rows[i].t_s);
  }
  if (count == 0) return {};
  return fmt::format("{} step{} of over {} m/s between poses, {}: no car drives that", count,
                     count == 1 ? "" : "s", fastest_mps, count == 1 ? first : "the first " + first);
}

/// What a log's poses make.
DriveOfFile drive_of_measured(const map::LogDrive& log, const std::string& name,
                              const DriveOptions& options) {
  DriveOfFile read{.drive = drive_of(of_log(log, options), name, options),
                   .notes = log.notes,
                   .is_planned = log.is_planned};
  if (!log.is_planned) read.gaps = gaps_between(log.poses);
  if (!read.gaps.empty()) read.notes.push_back(gaps_note(read.gaps));
  const std::string jumps = jumps_note(read.drive.points());
  if (!jumps.empty()) read.notes.push_back(jumps);
  return read;
}

}  // namespace

bool is_of_camera(const DriveOptions& options) {
  return options.pose_frame && options.pose_frame->is_camera;
}

DrivePose flat_pose(double t_s, const Eigen::Isometry3d& pose, const DriveOptions& options) {
  Eigen::Vector3d place = pose.translation(), ahead = pose.linear().col(0);
  if (is_of_camera(options)) {
    Eigen::Matrix3d upright_from_camera;
    upright_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    place = upright_from_camera * place;
    ahead = upright_from_camera * pose.linear().col(2);
  }
  return {.t_s = t_s,
          .x_m = place.x(),
          .y_m = place.y(),
          .heading_rad = std::atan2(ahead.y(), ahead.x()),
          .z_m = place.z()};
}

double needed_step_s(const DriveOptions& options, const std::string& name,
                     const std::string& format) {
  if (options.rate_hz) return 1.0 / *options.rate_hz;
  throw map::InputError({.file = name,
                         .found = "is " + format + ", which has no times",
                         .needed = "--rate HZ, how many poses there are in a second",
                         .remedy = "give it"});
}

std::string notes_text(const std::string& name, const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += fmt::format("note: {}: {}\n", name, note);
  return text;
}

DriveOfFile read_drive(const fs::path& file, const DriveOptions& options) {
  const std::string name = map::input_name(file);
  if (map::is_log(file)) {
    const auto frame = options.pose_frame ? map::DriveFrame::recorded : map::DriveFrame::vehicle;
    const map::LogDrive log = map::drive_of_log(file, options.topic, "--topic", frame);
    if (log.rows.empty()) return drive_of_measured(log, name, options);
    return {.drive = drive_of_rows(log.rows, name)};
  }
  return {.drive = parse_drive(map::read_file(file, map::most_unpacked_of_rows), name, options)};
}

geometry::Trajectory parse_drive(std::string_view bytes, const std::string& name,
                                 const DriveOptions& options) {
  const DriveFormat* format = format_of(bytes);
  if (format == nullptr) {
    map::refuse_unusable_log(bytes, name);
    return parse_trajectory_csv(bytes, name);
  }
  return drive_of(format->parse(bytes, name, options), name, options);
}

bool is_solution(const fs::path& file) {
  if (map::is_folder(file) || map::is_log(file)) return false;
  return begins_as_solution(map::read_file_start(file, kStart));
}

bool is_drive_table(const fs::path& file) {
  return !map::is_log(file) && format_of(map::read_file_start(file, kStart)) == nullptr;
}

}  // namespace roadbed::tools::files
