#include "roadbed/tools/audit/argoverse_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/files/files_named.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/logs/argoverse_annotations.h"
#include "roadbed/map/logs/argoverse_poses.h"
#include "roadbed/map/logs/transform_tree.h"
#include "roadbed/map/occupancy/clouds/cloud_filter.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/tools/audit/obstacle_finder.h"

namespace roadbed::tools::inline audit {
namespace {

namespace fs = std::filesystem;
using planning::ObstacleInSource;

constexpr double kCell_m = 0.1, kCarveRange_m = 40.0, kSweep_s = 0.1;

[[noreturn]] void refuse_log(const fs::path& folder, const std::string& found,
                             const std::string& needed) {
  throw map::InputError({.file = map::input_name(folder),
                         .found = found,
                         .needed = needed,
                         .remedy = "name the folder of one sensor log of Argoverse 2"});
}

/// One track in the city, over time.
class TrackRows {
 public:
  void add(double t_s, const Eigen::Isometry3d& pose, const Eigen::Vector3d& size_m) {
    const Eigen::Vector3d front = pose.linear().col(0);
    rows_.push_back({.t_s = t_s,
                     .x_m = pose.translation().x(),
                     .y_m = pose.translation().y(),
                     .heading_rad = std::atan2(front.y(), front.x())});
    size_m_ = size_m_.cwiseMax(size_m.head<2>());
  }

  // One that was seen in one sweep only is there until the next one.
  ObstacleInSource obstacle(const std::string& id, const std::string& kind) && {
    if (rows_.size() == 1) {
      rows_.push_back(rows_.front());
      rows_.back().t_s += kSweep_s;
    }
    ObstacleInSource obstacle{.id = id,
                              .kind = kind,
                              .length_m = size_m_.x(),
                              .width_m = size_m_.y(),
                              .motion = geometry::Trajectory(std::move(rows_))};
    obstacle.validity = {obstacle.motion.start_s(), obstacle.motion.end_s()};
    return obstacle;
  }

 private:
  std::vector<geometry::TrajectoryPoint> rows_;
  Eigen::Vector2d size_m_{0.0, 0.0};
};

[[noreturn]] void refuse_box(const fs::path& file, std::size_t row, const std::string& found,
                             const std::string& needed) {
  throw map::InputError({.file = map::input_name(file),
                         .place = fmt::format("row {}", row + 1),
                         .element = "timestamp_ns",
                         .found = found,
                         .needed = needed,
                         .remedy = "get poses and annotations of the same log"});
}

std::vector<ObstacleInSource> annotated_obstacles(const ArgoverseLog& log) {
  if (log.annotations.empty()) {
    refuse_log(log.poses.parent_path(), "has no annotations.feather", "it, or --boxes found");
  }
  std::vector<map::TimedPose> poses =
      map::read_ego_poses(map::read_file(log.poses), map::input_name(log.poses));
  map::sort_by_stamp(poses);
  const std::string name = map::input_name(log.annotations);
  const auto boxes = map::read_annotations(map::read_file(log.annotations), name);
  std::vector<std::size_t> by_time(boxes.size());
  for (std::size_t i = 0; i < by_time.size(); ++i) by_time[i] = i;
  std::ranges::stable_sort(by_time, {}, [&](std::size_t i) { return boxes[i].stamp_ns; });
  std::map<std::string, std::pair<std::string, TrackRows>> tracks;
  std::map<std::string, std::int64_t> last_ns;
  for (const std::size_t row : by_time) {
    const map::AnnotatedBox& box = boxes[row];
    const auto city_from_ego = map::pose_at(poses, box.stamp_ns);
    if (!city_from_ego) {
      refuse_box(log.annotations, row, fmt::format("is {} ns", box.stamp_ns),
                 "a time between the first and the last pose");
    }
    const auto [last, is_new] = last_ns.emplace(box.track, box.stamp_ns);
    if (!is_new && std::exchange(last->second, box.stamp_ns) == box.stamp_ns) {
      refuse_box(log.annotations, row, "is that of another box of the same track", "one a time");
    }
    auto& [category, rows] = tracks[box.track];
    category = box.category;
    rows.add(1e-9 * static_cast<double>(box.stamp_ns - poses.front().stamp_ns),
             *city_from_ego * box.pose, box.size_m);
  }
  std::vector<ObstacleInSource> obstacles;
  for (auto& [track, of] : tracks) {
    obstacles.push_back(std::move(of.second).obstacle(track, of.first));
  }
  return obstacles;
}

/// Goes through the sweeps of a log, one after the other.
void for_each_sweep(const ArgoverseLog& log, const std::function<void(map::PointCloud)>& use) {
  for (const fs::path& file : log.sweeps) {
    map::PointCloud sweep = map::read_point_cloud(file);
    if (!sweep.stamp_ns) {
      refuse_log(log.poses.parent_path(), fmt::format("has a sweep {}", file.filename().string()),
                 "sweeps that are named by their times [ns]");
    }
    use(std::move(sweep));
  }
}

std::vector<ObstacleInSource> found_obstacles(const ArgoverseLog& log, int threads) {
  ObstacleFinder finder({}, CloudClock([] { return std::nullopt; }, 0.1), threads);
  for_each_sweep(log, [&](map::PointCloud sweep) { finder.take(std::move(sweep)); });
  return finder.obstacles();
}

/// Without what boxes that come and go stand for.
map::PointCloud without_movers(map::PointCloud sweep,
                               const std::vector<ObstacleInSource>& obstacles) {
  const double t_s = 1e-9 * static_cast<double>(*sweep.stamp_ns - *sweep.drive_start_ns);
  std::vector<geometry::Rectangle> boxes;
  for (const ObstacleInSource& obstacle : obstacles) {
    constexpr double rounding_s = 1e-6;
    const bool is_there =
        obstacle.is_there(t_s + rounding_s) || obstacle.is_there(t_s - rounding_s);
    if (obstacle.validity.from_s == planning::kAlways.from_s || !is_there) continue;
    boxes.push_back(rectangle_at(obstacle, t_s));
  }
  return map::leaving_out(std::move(sweep), [&](const Eigen::Vector3d& in_source) {
    constexpr double noise_m = 0.1;
    const Eigen::Vector2d point = in_source.head<2>();
    return std::ranges::any_of(boxes, [&](const geometry::Rectangle& box) {
      const double reach_m = box.radius_m() + noise_m;
      return (point - box.centre).squaredNorm() <= reach_m * reach_m &&
             geometry::distance_m(box, point) <= noise_m;
    });
  });
}

}  // namespace

fs::path drive_of_argoverse_log(const fs::path& folder) {
  return folder / "city_SE3_egovehicle.feather";
}

ArgoverseLog argoverse_log(const fs::path& folder) {
  std::error_code unreadable;
  if (!fs::is_directory(folder, unreadable)) {
    refuse_log(folder, "is no folder", "sensors, poses and map of a log");
  }
  ArgoverseLog log{.poses = drive_of_argoverse_log(folder),
                   .map = {},
                   .annotations = folder / "annotations.feather",
                   .sweeps = map::files_named(folder / "sensors" / "lidar", "", ".feather")};
  if (!fs::exists(log.poses, unreadable)) {
    refuse_log(folder, "has no city_SE3_egovehicle.feather", "the poses of its ego");
  }
  const auto maps = map::files_named(folder / "map", "log_map_archive_", ".json");
  if (maps.size() != 1) {
    refuse_log(folder, fmt::format("has {} maps log_map_archive_*.json in its map", maps.size()),
               "one");
  }
  log.map = maps.front();
  if (log.sweeps.empty()) {
    refuse_log(folder, "has no *.feather in its sensors/lidar", "a sweep at least");
  }
  if (!fs::exists(log.annotations, unreadable)) log.annotations.clear();
  return log;
}

LogScene scene_of_log(const ArgoverseLog& log, LogBoxes boxes, int threads) {
  LogScene scene;
  scene.obstacles =
      boxes == LogBoxes::annotated ? annotated_obstacles(log) : found_obstacles(log, threads);
  const map::CloudsInTurn in_turn([&](const std::function<void(const map::PointCloud&)>& use) {
    for_each_sweep(log, [&](map::PointCloud sweep) {
      sweep = without_movers(std::move(sweep), scene.obstacles);
      if (!sweep.points.empty()) use(sweep);
    });
  });
  scene.occupancy = std::make_shared<const map::OccupancyMap>(
      map::OccupancyMap::build(in_turn, {.resolution_m = kCell_m, .carve_range_m = kCarveRange_m}));
  return scene;
}

}  // namespace roadbed::tools::audit
