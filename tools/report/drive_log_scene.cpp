#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "roadbed/map/files/visible_text.h"
#include "roadbed/tools/report/drive_log.h"
#include "roadbed/tools/report/occupied_points.h"

namespace roadbed::tools::inline report {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Pose2;
using geometry::TrajectoryPoint;

// Okabe and Ito's, as on pages.
constexpr FoxgloveColor kLaneColor{0.6, 0.6, 0.6}, kCentreColor{0.6, 0.6, 0.6, 0.4},
    kRouteColor{0.34, 0.71, 0.91}, kReferenceColor{0.0, 0.45, 0.70}, kGood{0.0, 0.62, 0.45},
    kBad{0.84, 0.37, 0.0}, kOpen{0.90, 0.62, 0.0}, kVehicleColor{0.0, 0.45, 0.70, 0.8},
    kObstacleColor{0.80, 0.47, 0.65, 0.8};

constexpr double kObstacleHeight_m = 1.5, kAround_m = 60.0;

FoxgloveColor color_of(planning::Verdict verdict) {
  const Tone tone = tone_of(verdict);
  return tone == Tone::good ? kGood : tone == Tone::bad ? kBad : kOpen;
}

}  // namespace

std::vector<Vector3d> DriveLog::in_scene(const map::LaneLine& line) const {
  std::vector<Vector3d> places;
  for (std::size_t i = 0; i < line.in_map.points().size(); ++i) {
    places.push_back(in_scene(input_.scene.road_map->to_source(line.in_map.points()[i])));
    if (space_.ground != nullptr && space_.ground->surface) places.back().z() = line.z_m[i];
  }
  return places;
}

SceneEntity DriveLog::entity_of(const map::Lane& lane) const {
  SceneEntity shown = entity(map::visible_text(lane.name));
  shown.word("type", std::string(map::to_string(lane.type)))
      .line(in_scene(lane.left), 0.1, kLaneColor)
      .line(in_scene(lane.right), 0.1, kLaneColor)
      .line(in_scene(lane.centre), 0.05, kCentreColor);
  return shown;
}

void DriveLog::add_scene() {
  const ReportScene& scene = input_.scene;
  std::vector<SceneEntity> entities;
  if (scene.road_map) {
    for (const map::Lane& lane : scene.road_map->lanes()) entities.push_back(entity_of(lane));
  }
  add_entities("/scene/lanes", entities);
  entities.clear();
  for (std::size_t i = 0; i < scene.route.size(); ++i) {
    entities.push_back(entity(fmt::format("route {}", i + 1)));
    entities.back().line(in_scene(scene.route[i], 0.02), 0.4, kRouteColor);
  }
  for (std::size_t i = 0; i < scene.references.size(); ++i) {
    entities.push_back(entity(fmt::format("reference {}", i + 1)));
    entities.back().line(in_scene(scene.references[i], 0.03), 0.1, kReferenceColor);
  }
  if (scene.goal) {
    entities.push_back(entity("goal"));
    entities.back().cylinder(in_scene(*scene.goal, 0.1), {2.0, 2.0, 0.2}, kGood);
  }
  add_entities("/scene/route", entities);
  add_vehicle();
}

void DriveLog::add_vehicle() {
  std::vector<geometry::BodyPart> parts = space_.parts;
  if (parts.empty()) parts.push_back(geometry::body_of(input_.scene.vehicle));
  SceneEntity vehicle(start_ns(), kVehicleFrame, "vehicle");
  vehicle.locked();
  for (const geometry::BodyPart& part : parts) {
    const Vector2d middle = part.middle_in_vehicle();
    const double across_m = 2.0 * part.radius_m;
    const double height_m = part.to_height_m - part.from_height_m;
    const double z_m = 0.5 * (part.from_height_m + part.to_height_m);
    if (part.is_circle()) {
      vehicle.cylinder({middle.x(), middle.y(), z_m}, {across_m, across_m, height_m},
                       kVehicleColor);
    } else {
      vehicle.cube({middle.x(), middle.y(), 0.0}, z_m, {part.length_m(), part.width_m(), height_m},
                   kVehicleColor);
    }
  }
  add_entities("/scene/vehicle", {vehicle});
}

void DriveLog::add_occupancy() {
  if (space_.occupancy == nullptr) return;
  Eigen::AlignedBox2d box;
  for (const TrajectoryPoint& row : rows_) box.extend(row.pose().position());
  const Vector2d around_m = Vector2d::Constant(kAround_m);
  add("/occupancy", "foxglove.PointCloud", start_ns(),
      point_cloud(start_ns(), kSceneFrame,
                  occupied_points(*space_.occupancy, {box.min() - around_m, box.max() + around_m},
                                  origin_)));
}

SceneEntity DriveLog::entity_of(const planning::ObstacleInSource& obstacle, double t_s) const {
  const Pose2 pose = obstacle.pose_at(t_s);
  const Vector3d place = in_scene(pose.position(), 0.5 * kObstacleHeight_m);
  SceneEntity shown(at_ns(t_s), kSceneFrame, map::visible_text(obstacle.id));
  shown.word("kind", map::visible_text(obstacle.kind))
      .cube({place.x(), place.y(), pose.heading_rad}, place.z(),
            {obstacle.length_m, obstacle.width_m, kObstacleHeight_m}, kObstacleColor);
  return shown;
}

void DriveLog::add_obstacles() {
  const auto& obstacles = input_.scene.obstacles;
  const auto stays = [](const planning::ObstacleInSource& obstacle) {
    return obstacle.is_static() && !std::isfinite(obstacle.validity.from_s) &&
           !std::isfinite(obstacle.validity.to_s);
  };
  const bool all_stay = std::ranges::all_of(obstacles, stays);
  constexpr double step_s = 0.05 - 1e-6;
  double next_s = rows_.front().t_s;
  for (const TrajectoryPoint& row : rows_) {
    if (obstacles.empty() || row.t_s < next_s) continue;
    next_s = row.t_s + step_s;
    std::vector<SceneEntity> entities;
    for (const planning::ObstacleInSource& obstacle : obstacles) {
      if (obstacle.is_there(row.t_s)) entities.push_back(entity_of(obstacle, row.t_s));
    }
    add("/scene/obstacles", "foxglove.SceneUpdate", at_ns(row.t_s),
        scene_update(at_ns(row.t_s), entities, true));
    if (all_stay) return;
  }
}

LineInSource DriveLog::path_between(double from_s, double to_s) const {
  const geometry::Trajectory& drive = input_.drive.trajectory;
  LineInSource path{drive.at(from_s).pose().position()};
  for (const TrajectoryPoint& row : rows_) {
    if (row.t_s > from_s && row.t_s < to_s) path.push_back(row.pose().position());
  }
  path.push_back(drive.at(to_s).pose().position());
  return path;
}

void DriveLog::add_audit() {
  if (!space_.audit) return;
  std::vector<SceneEntity> entities;
  const auto stretches = judged_stretches(*space_.audit, rows_.front().t_s, rows_.back().t_s);
  for (const planning::JudgedStretch& stretch : stretches) {
    entities.push_back(entity(fmt::format("stretch {}", entities.size() + 1)));
    entities.back()
        .word("verdict", std::string(to_string(stretch.verdict)))
        .word("from_s", fmt::format("{}", stretch.from_s))
        .word("to_s", fmt::format("{}", stretch.to_s))
        .line(in_scene(path_between(stretch.from_s, stretch.to_s), 0.1), 0.3,
              color_of(stretch.verdict));
  }
  std::size_t number = 0;
  for (const planning::Conflict& conflict : space_.audit->conflicts) {
    entities.push_back(entity(fmt::format("conflict {}", ++number)));
    add_conflict(conflict, entities.back());
  }
  add_entities("/audit", entities);
  for (const planning::AuditReport::Sample& sample : space_.audit->profile) {
    const std::int64_t time_ns = at_ns(sample.t_s);
    add("/audit/clearance", "roadbed.Clearance", time_ns,
        map::ProtoWriter().message(1, time_proto(time_ns)).number(2, sample.clearance_m).bytes());
  }
}

void DriveLog::add_conflict(const planning::Conflict& conflict, SceneEntity& shown) const {
  const Vector2d &least = conflict.witness.min_in_source, &most = conflict.witness.max_in_source;
  const Vector2d size_m = (most - least).cwiseMax(0.05);
  const Vector3d place = in_scene(0.5 * (least + most), 0.5 * kObstacleHeight_m);
  const std::string text = map::visible_text(
      fmt::format("{:.2f} m to {}", conflict.least_clearance_m,
                  conflict.obstacle.empty() ? "occupied space" : conflict.obstacle));
  shown.word("from_s", fmt::format("{}", conflict.from_s))
      .word("to_s", fmt::format("{}", conflict.to_s))
      .word("least_clearance_m", fmt::format("{}", conflict.least_clearance_m))
      .word("part", map::visible_text(conflict.part))
      .cube({place.x(), place.y(), 0.0}, place.z(), {size_m.x(), size_m.y(), kObstacleHeight_m},
            kBad)
      .text(place + Vector3d(0.0, 0.0, kObstacleHeight_m), text, kBad);
}

}  // namespace roadbed::tools::report
