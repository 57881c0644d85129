#include "roadbed/tools/commands/occupancy/cloud_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/logs/log.h"
#include "roadbed/map/logs/log_drive.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/clouds/sensor_poses.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"

namespace roadbed::tools::inline commands::inline occupancy {
namespace {

constexpr const char* kNoSensor =
    "no sensor position, so all but its hits stays unknown; give --sensor X,Y,Z";

void note_left_out(const CloudInputs::Note& note, const std::string& name, std::size_t dropped,
                   std::size_t kept) {
  if (dropped == 0) return;
  note(name,
       fmt::format("{} of {} points are not finite and were left out", dropped, dropped + kept));
}

void note_filtered(const CloudInputs::Note& note, const std::string& name, std::size_t count) {
  if (count > 0) note(name, fmt::format("{} points do not count, as the filter says", count));
}

void note_all(const CloudInputs::Note& note, const map::PointCloud& cloud, bool needs_sensor) {
  for (const std::string& text : cloud.notes) note(cloud.name, text);
  note_left_out(note, cloud.name, cloud.dropped_not_finite, cloud.points.size());
  note_filtered(note, cloud.name, cloud.filtered_out);
  if (needs_sensor && !cloud.has_sensor()) note(cloud.name, kNoSensor);
}

[[noreturn]] void refuse_octree(const std::filesystem::path& file, bool for_octree) {
  throw map::InputError(
      {.file = map::input_name(file),
       .found = "is an octree where clouds are asked for",
       .needed = for_octree ? "one octree alone, without --tiles, or point clouds" : "point clouds",
       .remedy = "give the clouds that the octree was built from"});
}

}  // namespace

void declare_cloud_topics(Arguments& arguments, map::LogCloudTopics& topics) {
  arguments.add("--topic", topics.clouds,
                "Of a log: the topic of PointCloud2 that is meant, where there are several "
                "(drive info lists them)");
  arguments.add("--pose-topic", topics.poses,
                "Of a log: the topic that says where its sensors were, transforms or poses. "
                "Default: its transforms, or its only topic of poses with them below");
}

void CloudInputs::declare(Arguments& arguments, bool for_octree) {
  for_octree_ = for_octree;
  std::string help =
      "Point clouds (.pcd .ply .las .laz .xyz .csv .bin .feather) in one frame, in metres; logs (a "
      "bag's folder, .db3 or .mcap), whose PointCloud2 messages are placed by the poses of the "
      "same "
      "log, or stand as they are without any";
  if (for_octree) help += "; or one octree (.bt .ot) to convert";
  arguments.add("CLOUD", files_, help).required().reads().ending(kCloudInputEndings);
}

void CloudInputs::declare_sensor(Arguments& arguments) {
  declare_cloud_topics(arguments, topics_);
  arguments
      .add("--sensor", sensor_,
           "X,Y,Z of the sensor for all clouds, from where rays carve and ranges count. Without it "
           "the position that a cloud has for each point counts (fields or columns sensor_x "
           "sensor_y sensor_z, vp_x…, x_origin… or BeamOriginX…), else the viewpoint of a .pcd")
      .separated_by(',')
      .values(3)
      .excludes(arguments
                    .add("--poses", poses_file_,
                         "Where the sensor was, a line for each cloud in their order (TUM: "
                         "timestamp tx ty tz qx "
                         "qy qz qw; KITTI: 3 by 4 matrix): the clouds are in the sensor's frame, "
                         "and so are positions that they have for each point")
                    .reads());
  if (!for_octree_) return;
  arguments.flag("--no-carving", no_carving_, "Only mark hits, whatever viewpoints the files name");
}

void CloudInputs::declare_changes(Arguments& arguments) {
  filter_.declare(arguments);
  arguments.add("--voxel", of_neighbours_.voxel_m, "Thin each cloud to a point per cube [m] (PCL)")
      .within(1e-3, 1e3);
  arguments
      .add("--outlier-neighbours", of_neighbours_.outlier_neighbours,
           "Leave out points far from this many neighbours, as compared to the rest (PCL)")
      .within(1, 1000);
  arguments
      .add("--outlier-deviations", of_neighbours_.outlier_deviations,
           "Far is this many standard deviations over the mean distance")
      .positive()
      .with_default();
  arguments
      .add("--scale", scale_,
           "Multiplies the clouds' coordinates, where they are not metres (feet: 0.3048); "
           "--sensor "
           "and --poses are in metres")
      .within(1e-6, 1e6);
  arguments.add("--crs", crs_, "CRS of the clouds, where the files give none or a wrong one");
}

std::string CloudInputs::first_name() const { return map::input_name(files_.front()); }

std::optional<std::string> CloudInputs::only_octree() const {
  if (files_.size() != 1 || map::is_log(files_.front())) return std::nullopt;
  std::string bytes = map::read_file(files_.front(), map::most_unpacked_of_rows);
  return map::is_occupancy_file(bytes) ? std::optional(std::move(bytes)) : std::nullopt;
}

bool CloudInputs::hold_logs() const { return std::ranges::any_of(files_, map::is_log); }

std::optional<std::int64_t> CloudInputs::drive_start_ns() const {
  const auto log = std::ranges::find_if(files_, map::is_log);
  if (log == files_.end()) return std::nullopt;
  const map::LogDrive drive = map::drive_of_log(*log, topics_.poses, "--pose-topic");
  if (!drive.poses.empty()) return drive.poses.front().stamp_ns;
  throw map::InputError({.file = map::input_name(*log),
                         .element = drive.topic,
                         .found = "holds rows, which do not say when they began",
                         .needed = "poses",
                         .remedy = "name a topic of poses by --pose-topic"});
}

void CloudInputs::for_each(const std::function<void(map::PointCloud)>& use,
                           const Note& note) const {
  const std::vector<Eigen::Isometry3d> world_from_sensor = poses();
  bool is_any_left = false;
  const auto take = [&](map::PointCloud cloud) {
    is_any_left = true;
    use(std::move(cloud));
  };
  for (std::size_t i = 0; i < files_.size(); ++i) {
    if (map::is_log(files_[i])) {
      take_log(files_[i], take, note);
    } else {
      pass_on(cloud_of(i, world_from_sensor), take, note);
    }
  }
  if (is_any_left) return;
  throw map::InputError({.file = first_name(),
                         .found = "no point of the clouds is left",
                         .needed = "at least one",
                         .remedy = "filter less"});
}

void CloudInputs::pass_on(map::PointCloud cloud, const std::function<void(map::PointCloud)>& use,
                          const Note& note) const {
  if (note) note_all(note, cloud, for_octree_ && !no_carving_);
  if (!cloud.points.empty()) use(std::move(cloud));
}

void CloudInputs::take_log(const std::filesystem::path& log,
                           const std::function<void(map::PointCloud)>& use,
                           const Note& note) const {
  if (!poses_file_.empty()) {
    throw map::InputError({.file = map::input_name(log),
                           .element = "--poses",
                           .found = "is a log, which has poses of its own",
                           .needed = "a cloud for each line of poses",
                           .remedy = "leave --poses out"});
  }
  const map::LogClouds clouds(log, topics_);
  std::size_t points = 0, filtered_out = 0;
  bool have_sensor = true;
  const map::LogCloudCounts counts = clouds.for_each(
      [&](map::PointCloud cloud) {
        points += cloud.points.size();
        cloud.filtered_out = 0;
        if (scale_) cloud = map::scaled_to_metres(cloud, *scale_);
        cloud = prepared(std::move(cloud));
        filtered_out += cloud.filtered_out;
        have_sensor &= cloud.has_sensor();
        if (!cloud.points.empty()) use(std::move(cloud));
      },
      filter_.filter());
  if (!note) return;
  note_filtered(note, map::input_name(log), counts.filtered_out + filtered_out);
  for (const std::string& text : clouds.notes(counts)) note(map::input_name(log), text);
  note_left_out(note, map::input_name(log), counts.not_finite, points);
  if (for_octree_ && !no_carving_ && !have_sensor) note(map::input_name(log), kNoSensor);
}

map::PointCloud CloudInputs::cloud_of(std::size_t i,
                                      const std::vector<Eigen::Isometry3d>& poses) const {
  const std::string bytes = map::read_file(files_[i], map::most_unpacked_of_rows);
  if (map::is_occupancy_file(bytes)) refuse_octree(files_[i], for_octree_);
  map::PointCloud cloud =
      poses.empty() ? map::point_cloud_of(files_[i], bytes, filter_.filter())
                    : map::parse_point_cloud(bytes, map::input_name(files_[i]), filter_.filter());
  if (scale_) cloud = map::scaled_to_metres(cloud, *scale_);
  if (!poses.empty()) cloud = map::placed(cloud, poses[i]);
  return prepared(std::move(cloud));
}

std::vector<Eigen::Isometry3d> CloudInputs::poses() const {
  if (poses_file_.empty()) return {};
  std::vector<Eigen::Isometry3d> poses = map::read_sensor_poses(poses_file_);
  if (poses.size() == files_.size()) return poses;
  throw map::InputError({.file = poses_file_.string(),
                         .found = fmt::format("holds {} poses", poses.size()),
                         .needed = fmt::format("one for each of {} clouds", files_.size()),
                         .remedy = "give as many clouds as poses, in the same order"});
}

map::PointCloud CloudInputs::prepared(map::PointCloud cloud) const {
  map::check_is_in_metres(cloud);
  if (!sensor_.empty()) {
    cloud.scans.clear();
    cloud.sensor_in_source = {sensor_[0], sensor_[1], sensor_[2]};
  }
  cloud = map::within_reach(std::move(cloud), filter_.filter(), "give --sensor X,Y,Z or --poses");
  if (no_carving_ || !for_octree_) {
    cloud.scans.clear();
    cloud.sensor_in_source.reset();
  }
  if (of_neighbours_.looks_at_neighbours() && !cloud.points.empty()) {
    cloud = map::filtered(cloud, of_neighbours_);
  }
  if (!crs_.empty()) cloud.crs = crs_;
  return cloud;
}

}  // namespace roadbed::tools::commands::occupancy
