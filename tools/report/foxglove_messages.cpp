#include "roadbed/tools/report/foxglove_messages.h"

#include <bit>
#include <cmath>

namespace roadbed::tools::inline report {
namespace {

using map::ProtoWriter;

ProtoWriter color_proto(const FoxgloveColor& color) {
  return ProtoWriter().number(1, color.r).number(2, color.g).number(3, color.b).number(4, color.a);
}

void put_float(std::string& bytes, float value) {
  auto bits = std::bit_cast<std::uint32_t>(value);
  for (int i = 0; i < 4; ++i, bits >>= 8) bytes.push_back(static_cast<char>(bits & 0xff));
}

}  // namespace

ProtoWriter time_proto(std::int64_t time_ns) {
  constexpr std::int64_t second_ns = 1'000'000'000;
  return ProtoWriter()
      .whole(1, static_cast<std::uint64_t>(time_ns / second_ns))
      .whole(2, static_cast<std::uint64_t>(time_ns % second_ns));
}

ProtoWriter vector_proto(const Eigen::Vector3d& vector) {
  return ProtoWriter().number(1, vector.x()).number(2, vector.y()).number(3, vector.z());
}

ProtoWriter turn_proto(double heading_rad) {
  return ProtoWriter()
      .number(1, 0.0)
      .number(2, 0.0)
      .number(3, std::sin(0.5 * heading_rad))
      .number(4, std::cos(0.5 * heading_rad));
}

ProtoWriter pose_proto(const geometry::Pose2& pose, double z_m) {
  return ProtoWriter()
      .message(1, vector_proto({pose.x_m, pose.y_m, z_m}))
      .message(2, turn_proto(pose.heading_rad));
}

std::string frame_transform(std::int64_t time_ns, const std::string& parent,
                            const std::string& child, const geometry::Pose2& pose, double z_m) {
  return ProtoWriter()
      .message(1, time_proto(time_ns))
      .bytes(2, parent)
      .bytes(3, child)
      .message(4, vector_proto({pose.x_m, pose.y_m, z_m}))
      .message(5, turn_proto(pose.heading_rad))
      .bytes();
}

std::string poses_along(std::int64_t time_ns, const std::string& frame,
                        std::span<const Eigen::Vector3d> line) {
  ProtoWriter poses;
  poses.message(1, time_proto(time_ns)).bytes(2, frame);
  double heading_rad = 0.0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (i + 1 < line.size()) {
      const Eigen::Vector3d step = line[i + 1] - line[i];
      if (step.head<2>().norm() > 0.0) heading_rad = std::atan2(step.y(), step.x());
    }
    poses.message(3, pose_proto({line[i].x(), line[i].y(), heading_rad}, line[i].z()));
  }
  return poses.bytes();
}

std::string point_cloud(std::int64_t time_ns, const std::string& frame,
                        std::span<const SizedPoint> points) {
  constexpr std::uint64_t float32 = 7;
  constexpr std::uint32_t stride = 16;
  ProtoWriter cloud;
  cloud.message(1, time_proto(time_ns))
      .bytes(2, frame)
      .message(3, pose_proto({0.0, 0.0, 0.0}, 0.0))
      .fixed32(4, stride);
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z", "size"}) {
    cloud.message(5, ProtoWriter().bytes(1, name).fixed32(2, offset).whole(3, float32));
    offset += 4;
  }
  std::string data;
  data.reserve(points.size() * stride);
  for (const SizedPoint& point : points) {
    for (const float value : point.place) put_float(data, value);
    put_float(data, point.size_m);
  }
  return cloud.bytes(6, data).bytes();
}

std::string log_message(std::int64_t time_ns, FoxgloveLevel level, const std::string& name,
                        const std::string& text) {
  return ProtoWriter()
      .message(1, time_proto(time_ns))
      .whole(2, static_cast<std::uint64_t>(level))
      .bytes(3, text)
      .bytes(4, name)
      .bytes();
}

std::string location_fix(std::int64_t time_ns, const std::string& frame,
                         const Eigen::Vector2d& lon_lat_deg, double z_m) {
  return ProtoWriter()
      .number(1, lon_lat_deg.y())
      .number(2, lon_lat_deg.x())
      .number(3, z_m)
      .message(6, time_proto(time_ns))
      .bytes(7, frame)
      .bytes();
}

SceneEntity::SceneEntity(std::int64_t time_ns, const std::string& frame, const std::string& id) {
  proto_.message(1, time_proto(time_ns)).bytes(2, frame).bytes(3, id);
}

SceneEntity& SceneEntity::locked() {
  proto_.whole(5, 1);
  return *this;
}

SceneEntity& SceneEntity::word(const std::string& key, const std::string& value) {
  proto_.message(6, ProtoWriter().bytes(1, key).bytes(2, value));
  return *this;
}

SceneEntity& SceneEntity::cube(const geometry::Pose2& centre, double z_m,
                               const Eigen::Vector3d& size_m, const FoxgloveColor& color) {
  proto_.message(8, ProtoWriter()
                        .message(1, pose_proto(centre, z_m))
                        .message(2, vector_proto(size_m))
                        .message(3, color_proto(color)));
  return *this;
}

SceneEntity& SceneEntity::cylinder(const Eigen::Vector3d& centre, const Eigen::Vector3d& size_m,
                                   const FoxgloveColor& color) {
  proto_.message(10, ProtoWriter()
                         .message(1, pose_proto({centre.x(), centre.y(), 0.0}, centre.z()))
                         .message(2, vector_proto(size_m))
                         .number(3, 1.0)
                         .number(4, 1.0)
                         .message(5, color_proto(color)));
  return *this;
}

SceneEntity& SceneEntity::line(std::span<const Eigen::Vector3d> points, double thickness_m,
                               const FoxgloveColor& color) {
  ProtoWriter line;
  line.whole(1, 0).message(2, pose_proto({0.0, 0.0, 0.0}, 0.0)).number(3, thickness_m);
  for (const Eigen::Vector3d& point : points) line.message(5, vector_proto(point));
  proto_.message(11, line.message(6, color_proto(color)));
  return *this;
}

SceneEntity& SceneEntity::text(const Eigen::Vector3d& at, const std::string& text,
                               const FoxgloveColor& color) {
  proto_.message(13, ProtoWriter()
                         .message(1, pose_proto({at.x(), at.y(), 0.0}, at.z()))
                         .whole(2, 1)
                         .number(3, 0.5)
                         .message(5, color_proto(color))
                         .bytes(6, text));
  return *this;
}

std::string scene_update(std::int64_t time_ns, std::span<const SceneEntity> entities,
                         bool replaces) {
  constexpr std::uint64_t all = 1;
  ProtoWriter update;
  if (replaces) {
    update.message(1, ProtoWriter().message(1, time_proto(time_ns)).whole(2, all));
  }
  for (const SceneEntity& entity : entities) update.message(2, entity.proto());
  return update.bytes();
}

}  // namespace roadbed::tools::report
