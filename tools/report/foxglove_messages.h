#pragma once

// Private to tools/report: values of Foxglove's messages, see map/logs/foxglove_schemas.h.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/logs/protobuf.h"
#include "roadbed/tools/report/occupied_points.h"

namespace roadbed::tools::inline report {

/// Red, green, blue, and how opaque, 0 to 1.
struct FoxgloveColor {
  double r, g, b, a = 1.0;
};

map::ProtoWriter time_proto(std::int64_t time_ns);
map::ProtoWriter vector_proto(const Eigen::Vector3d& vector);
/// Of something upright.
map::ProtoWriter turn_proto(double heading_rad);
map::ProtoWriter pose_proto(const geometry::Pose2& pose, double z_m);

/// foxglove.FrameTransform
std::string frame_transform(std::int64_t time_ns, const std::string& parent,
                            const std::string& child, const geometry::Pose2& pose, double z_m);

/// foxglove.PosesInFrame: places of a line, each turned to the next one.
std::string poses_along(std::int64_t time_ns, const std::string& frame,
                        std::span<const Eigen::Vector3d> line);

/// foxglove.PointCloud of x, y, z as floats, and the size of each.
std::string point_cloud(std::int64_t time_ns, const std::string& frame,
                        std::span<const SizedPoint> points);

/// foxglove.Log
enum class FoxgloveLevel : std::uint64_t { info = 2, warning = 3, error = 4 };
std::string log_message(std::int64_t time_ns, FoxgloveLevel level, const std::string& name,
                        const std::string& text);

/// foxglove.LocationFix
std::string location_fix(std::int64_t time_ns, const std::string& frame,
                         const Eigen::Vector2d& lon_lat_deg, double z_m);

/// A thing of a scene, foxglove.SceneEntity: shapes in one frame, with words about it.
class SceneEntity {
 public:
  SceneEntity(std::int64_t time_ns, const std::string& frame, const std::string& id);

  /// It moves with its frame.
  SceneEntity& locked();
  SceneEntity& word(const std::string& key, const std::string& value);
  SceneEntity& cube(const geometry::Pose2& centre, double z_m, const Eigen::Vector3d& size_m,
                    const FoxgloveColor& color);
  SceneEntity& cylinder(const Eigen::Vector3d& centre, const Eigen::Vector3d& size_m,
                        const FoxgloveColor& color);
  SceneEntity& line(std::span<const Eigen::Vector3d> points, double thickness_m,
                    const FoxgloveColor& color);
  SceneEntity& text(const Eigen::Vector3d& at, const std::string& text, const FoxgloveColor& color);

  const map::ProtoWriter& proto() const { return proto_; }

 private:
  map::ProtoWriter proto_;
};

/// foxglove.SceneUpdate
/// @param replaces  what the topic showed before is gone.
std::string scene_update(std::int64_t time_ns, std::span<const SceneEntity> entities,
                         bool replaces = false);

}  // namespace roadbed::tools::report
