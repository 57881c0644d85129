#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/clouds/cloud_transforms.h"
#include "roadbed/map/occupancy/clouds/log_clouds.h"
#include "roadbed/map/occupancy/clouds/point_cloud.h"
#include "roadbed/tools/cli/arguments.h"
#include "roadbed/tools/commands/occupancy/filter_arguments.h"

namespace roadbed::tools::inline commands::inline occupancy {

/// What the names of clouds, octrees and logs end in, for Argument::ending.
inline constexpr std::string_view kCloudInputEndings =
    ".pcd .ply .las .laz .xyz .bin .feather .bt .ot .db3 .mcap";

/// Declares `--topic` and `--pose-topic`.
void declare_cloud_topics(Arguments& arguments, map::LogCloudTopics& topics);

/// The point clouds that a command line names, of files and of logs, and what it does to them
/// before they are measured.
class CloudInputs {
 public:
  /// @param for_octree  whether an octree is made of them: rays carve, and one octree may stand in
  ///                    place of clouds.
  void declare(Arguments& arguments, bool for_octree = true);
  /// From where they were measured.
  void declare_sensor(Arguments& arguments);
  /// Filters, scale, CRS.
  void declare_changes(Arguments& arguments);

  /// As the user named it.
  std::string first_name() const;

  /// The bytes of the only input, if that is an octree.
  std::optional<std::string> only_octree() const;

  /// Whether one of them is a log, whose clouds may be more than memory holds.
  bool hold_logs() const;

  /// When the drive of the first log among them begins, as `audit --trajectory` counts its times;
  /// none where there is no log. @throws InputError if the log does not say which drive is meant.
  std::optional<std::int64_t> drive_start_ns() const;

  /// Takes what the user may want to know of an input.
  using Note = std::function<void(const std::string& name, const std::string& text)>;

  /// All clouds one after the other, ready to be measured.
  /// @param note  may be empty.
  /// @throws InputError if an input cannot be used, or is an octree.
  void for_each(const std::function<void(map::PointCloud)>& use, const Note& note) const;

 private:
  void pass_on(map::PointCloud cloud, const std::function<void(map::PointCloud)>& use,
               const Note& note) const;
  void take_log(const std::filesystem::path& log, const std::function<void(map::PointCloud)>& use,
                const Note& note) const;
  map::PointCloud cloud_of(std::size_t i, const std::vector<Eigen::Isometry3d>& poses) const;
  std::vector<Eigen::Isometry3d> poses() const;
  map::PointCloud prepared(map::PointCloud cloud) const;

  std::vector<std::filesystem::path> files_;
  std::filesystem::path poses_file_;
  map::LogCloudTopics topics_;
  std::vector<double> sensor_;
  std::optional<double> scale_;
  FilterArguments filter_;
  map::CloudFilter of_neighbours_;  // what needs PCL
  std::string crs_;
  bool no_carving_ = false, for_octree_ = true;
};

}  // namespace roadbed::tools::commands::occupancy
