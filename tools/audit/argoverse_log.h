#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::tools::inline audit {

/// A sensor log of Argoverse 2, as its folder holds it.
struct ArgoverseLog {
  std::filesystem::path poses;                ///< city_SE3_egovehicle.feather, of the ego's drive
  std::filesystem::path map;                  ///< map/log_map_archive_*.json
  std::filesystem::path annotations;          ///< annotations.feather; need not be there
  std::vector<std::filesystem::path> sweeps;  ///< sensors/lidar/TIME.feather, by their times
};

/// The files of a log. None is read.
/// @throws InputError if it is no folder, or one of poses, map and sweeps is not in it.
ArgoverseLog argoverse_log(const std::filesystem::path& folder);

/// The file in the folder of a log that is the ego's drive.
std::filesystem::path drive_of_argoverse_log(const std::filesystem::path& folder);

/// Where the boxes around the others come from: people, or the sweeps.
enum class LogBoxes { annotated, found };

/// What the ego of a log has driven among: in the city, in seconds of its drive.
struct LogScene {
  std::shared_ptr<const map::OccupancySource> occupancy;  ///< hits of the sweeps, in cells of 0.1 m
  std::vector<planning::ObstacleInSource> obstacles;
};

/// Sweeps are read one after the other: once to find boxes in them, twice for the occupancy. Points
/// of a sweep that lie in a box which is there at that time, and not for ever, are not in the
/// occupancy: the box stands for them, and where it has gone the space is free. Up to 40 m from the
/// lidars rays carve free space, if the log says where on the vehicle they are (its calibration);
/// else what has no point is unknown.
/// @throws InputError if a file is unusable, or there are no annotations and they are asked for.
LogScene scene_of_log(const ArgoverseLog& log, LogBoxes boxes, int threads);

}  // namespace roadbed::tools::audit
