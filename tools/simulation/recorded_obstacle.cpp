#include "roadbed/tools/simulation/recorded_obstacle.h"

#include <utility>
#include <vector>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/tools/files/drive_file.h"

namespace roadbed::tools::inline simulation {
namespace {

using geometry::Pose2;
using geometry::TrajectoryPoint;

constexpr Range kOverhang{0.0, 100.0}, kRate{1e-3, 1e6}, kTimeOffset{-1e10, 1e10};

DriveOptions options_in(const JsonNode& node, const geometry::VehicleShape& body) {
  DriveOptions options;
  if (const auto topic = node.find("topic")) options.topic = topic->one_line();
  if (const auto rate = node.find("rate_hz")) options.rate_hz = rate->number(kRate);
  if (const auto frame = node.find("pose_frame")) {
    options.pose_frame = pose_frame(frame->text(), body);
    if (!options.pose_frame) {
      frame->refuse("is \"" + frame->name() + "\"", kPoseFrameSyntax, "choose one");
    }
  }
  return options;
}

}  // namespace

RecordedObstacle recorded_obstacle_in(const JsonNode& node, const std::filesystem::path& folder,
                                      double length_m) {
  node.require_object({"file", "topic", "pose_frame", "rate_hz", "rear_overhang_m", "offset_s"});
  geometry::VehicleShape body;
  body.length_m = length_m;
  body.rear_overhang_m = node.number_or("rear_overhang_m", body.rear_overhang_m, kOverhang);
  return {.file = folder / node.at("file").text(),
          .pointer = node.pointer(),
          .options = options_in(node, body),
          .centre_in_vehicle = pose_frame("centre", body)->pose_in_vehicle,
          .offset_s = node.number_or("offset_s", 0.0, kTimeOffset)};
}

geometry::Trajectory motion_of(const RecordedObstacle& recorded) {
  std::vector<TrajectoryPoint> rows = read_drive(recorded.file, recorded.options).drive.points();
  for (TrajectoryPoint& row : rows) {
    const Pose2 centre = row.pose() * recorded.centre_in_vehicle;
    row.t_s += recorded.offset_s;
    row.x_m = centre.x_m;
    row.y_m = centre.y_m;
  }
  return geometry::Trajectory(std::move(rows));
}

}  // namespace roadbed::tools::simulation
