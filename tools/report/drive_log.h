#pragma once

// Private to tools/report: the messages of a drive's log, see drive_mcap.h.

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/elements/lane.h"
#include "roadbed/map/logs/mcap_writer.h"
#include "roadbed/tools/report/drive_space.h"
#include "roadbed/tools/report/foxglove_messages.h"
#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

// Frames: source coordinates as they are; the same from a place near the drive, since viewers draw
// in single precision; the rear axle.
inline constexpr const char *kMapFrame = "map", *kSceneFrame = "scene",
                            *kVehicleFrame = "base_link";

/// Gathers the messages of a drive's topics, and writes them in order of time.
class DriveLog {
 public:
  DriveLog(const ReportInput& input, const DriveSpace& space)
      : input_(input),
        space_(space),
        rows_(input.drive.trajectory.points()),
        origin_(rows_.front().pose().position().array().round()),
        writer_(input.origin.version) {
    constexpr double first_s = 0.0, last_s = 7.2e9;
    const bool fits = rows_.front().t_s >= first_s && rows_.back().t_s <= last_s;
    zero_s_ = fits ? 0.0 : rows_.front().t_s;
  }

  std::string bytes();

 private:
  struct Message {
    std::int64_t time_ns;
    std::uint16_t topic;
    std::string bytes;
  };

  void add(const std::string& topic, std::string_view type, std::int64_t time_ns,
           std::string bytes);
  void add_entities(const std::string& topic, const std::vector<SceneEntity>& entities);

  std::int64_t at_ns(double t_s) const;
  std::int64_t start_ns() const { return at_ns(rows_.front().t_s); }

  double z_m(const Eigen::Vector2d& in_source) const;
  Eigen::Vector3d in_scene(const Eigen::Vector2d& in_source, double above_m = 0.0) const;
  std::vector<Eigen::Vector3d> in_scene(const LineInSource& line, double above_m = 0.0) const;
  SceneEntity entity(const std::string& id) const { return {start_ns(), kSceneFrame, id}; }
  void add_frames();

  /// At its own heights where heights are above the map's roads, else on the level ground.
  std::vector<Eigen::Vector3d> in_scene(const map::LaneLine& line) const;
  SceneEntity entity_of(const map::Lane& lane) const;
  void add_scene();
  void add_vehicle();
  void add_occupancy();
  void add_rows();

  /// Where the map names its coordinate system, and that covers the drive.
  void add_fixes(std::vector<Eigen::Vector2d> lon_lat_deg);
  SceneEntity entity_of(const planning::ObstacleInSource& obstacle, double t_s) const;

  /// At rows of the drive, twenty in a second at most; what stands for ever once.
  void add_obstacles();
  void add_plans();
  /// The hypotheses of a cycle, and its candidates if they were kept.
  void add_considered(const DriveCycle& cycle, std::int64_t time_ns);
  /// Ways of some of its candidates, those with one cause in one entity.
  void add_candidate_lines(const DriveCycle& cycle, std::int64_t time_ns);
  void add_text(double t_s, FoxgloveLevel level, const std::string& name, const std::string& text);
  void add_texts();
  LineInSource path_between(double from_s, double to_s) const;

  /// Stretches of the way by verdict, all through the drive, and where its conflicts are nearest.
  void add_audit();
  void add_conflict(const planning::Conflict& conflict, SceneEntity& shown) const;

  const ReportInput& input_;
  const DriveSpace& space_;
  const std::vector<geometry::TrajectoryPoint>& rows_;
  Eigen::Vector2d origin_;
  double zero_s_ = 0.0;
  map::McapWriter writer_;
  std::map<std::string, std::uint16_t> topics_;
  std::vector<Message> messages_;
};

}  // namespace roadbed::tools::report
