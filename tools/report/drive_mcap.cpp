#include "roadbed/tools/report/drive_mcap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/gis/lon_lat.h"
#include "roadbed/map/logs/foxglove_schemas.h"
#include "roadbed/tools/report/drive_log.h"

namespace roadbed::tools::inline report {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::TrajectoryPoint;

FoxgloveLevel level_of(EventLevel level) {
  return level == EventLevel::info      ? FoxgloveLevel::info
         : level == EventLevel::warning ? FoxgloveLevel::warning
                                        : FoxgloveLevel::error;
}

}  // namespace

std::string DriveLog::bytes() {
  add_frames();
  add_scene();
  add_occupancy();
  add_rows();
  add_obstacles();
  add_plans();
  add_texts();
  add_audit();
  std::ranges::stable_sort(messages_, {}, &Message::time_ns);
  for (const Message& message : messages_) {
    writer_.write(message.topic, message.time_ns, message.bytes);
  }
  writer_.add_metadata("roadbed", {{"drive", map::visible_text(input_.scenario)},
                                   {"verdict", map::visible_text(input_.verdict.text)},
                                   {"command", map::visible_text(input_.origin.command)},
                                   {"crs", map::visible_text(input_.origin.crs)},
                                   {"t_s_at_time_0", fmt::format("{}", zero_s_)}});
  return writer_.finish();
}

void DriveLog::add(const std::string& topic, std::string_view type, std::int64_t time_ns,
                   std::string bytes) {
  auto& id = topics_[topic];
  if (id == 0) {
    id = writer_.add_topic({topic, std::string(type), "protobuf"}, map::foxglove_schema(type));
  }
  messages_.push_back({time_ns, id, std::move(bytes)});
}

void DriveLog::add_entities(const std::string& topic, const std::vector<SceneEntity>& entities) {
  if (entities.empty()) return;
  add(topic, "foxglove.SceneUpdate", start_ns(), scene_update(start_ns(), entities));
}

std::int64_t DriveLog::at_ns(double t_s) const {
  const double first_s = rows_.front().t_s, last_s = rows_.back().t_s;
  constexpr double last_ns = 9e18;
  return std::llround(std::min(1e9 * (std::clamp(t_s, first_s, last_s) - zero_s_), last_ns));
}

double DriveLog::z_m(const Vector2d& in_source) const {
  const planning::GroundUnder* ground = space_.ground;
  if (ground == nullptr) return 0.0;
  return ground->surface ? ground->surface->height_m(in_source) : ground->level_m;
}

Vector3d DriveLog::in_scene(const Vector2d& in_source, double above_m) const {
  const Vector2d place = in_source - origin_;
  return {place.x(), place.y(), z_m(in_source) + above_m};
}

std::vector<Vector3d> DriveLog::in_scene(const LineInSource& line, double above_m) const {
  std::vector<Vector3d> places;
  for (const Vector2d& point : line) places.push_back(in_scene(point, above_m));
  return places;
}

void DriveLog::add_frames() {
  add("/tf", "foxglove.FrameTransform", start_ns(),
      frame_transform(start_ns(), kMapFrame, kSceneFrame, {origin_.x(), origin_.y(), 0.0}, 0.0));
  for (const TrajectoryPoint& row : rows_) {
    const std::int64_t time_ns = at_ns(row.t_s);
    add("/tf", "foxglove.FrameTransform", time_ns,
        frame_transform(time_ns, kMapFrame, kVehicleFrame, row.pose(), z_m(row.pose().position())));
  }
}

void DriveLog::add_rows() {
  for (const TrajectoryPoint& row : rows_) {
    const std::int64_t time_ns = at_ns(row.t_s);
    map::ProtoWriter state;
    state.message(1, time_proto(time_ns));
    std::uint32_t field = 2;
    for (const double value : {row.t_s, row.x_m, row.y_m, row.heading_rad, row.speed_mps,
                               row.acceleration_mps2, row.steering_rad, row.curvature_per_m}) {
      state.number(field++, value);
    }
    add("/drive", map::kDriveStateType, time_ns, state.bytes());
  }
  LineInSource path;
  for (const TrajectoryPoint& row : rows_) path.push_back(row.pose().position());
  add("/drive/path", "foxglove.PosesInFrame", start_ns(),
      poses_along(start_ns(), kSceneFrame, in_scene(path)));
  add_fixes(path);
}

void DriveLog::add_fixes(std::vector<Vector2d> lon_lat_deg) {
  const auto& road_map = input_.scene.road_map;
  if (!road_map || road_map->crs().empty()) return;
  try {
    map::source_to_lon_lat(*road_map, lon_lat_deg);
  } catch (const map::InputError&) {
    return;
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const std::int64_t time_ns = at_ns(rows_[i].t_s);
    add("/fix", "foxglove.LocationFix", time_ns,
        location_fix(time_ns, kVehicleFrame, lon_lat_deg[i], z_m(rows_[i].pose().position())));
  }
}

void DriveLog::add_text(double t_s, FoxgloveLevel level, const std::string& name,
                        const std::string& text) {
  const std::int64_t time_ns = at_ns(t_s);
  add("/log", "foxglove.Log", time_ns, log_message(time_ns, level, name, map::visible_text(text)));
}

void DriveLog::add_texts() {
  for (const ReportDecision& decision : input_.decisions) {
    add_text(decision.from_s, FoxgloveLevel::info, decision.state, decision.reason);
  }
  for (const DriveEvent& event : input_.drive.events) {
    add_text(event.t_s, level_of(event.level), "event", event.text);
  }
  const Tone tone = input_.verdict.tone;
  add_text(rows_.back().t_s, tone == Tone::good ? FoxgloveLevel::info : FoxgloveLevel::error,
           "verdict", input_.verdict.text);
}

std::string drive_mcap(const ReportInput& input, const DriveSpace& space) {
  return DriveLog(input, space).bytes();
}

}  // namespace roadbed::tools::report
