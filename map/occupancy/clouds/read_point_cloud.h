#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "roadbed/map/occupancy/clouds/cloud_filter.h"
#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// Reads .pcd (ascii, binary, compressed), .ply, .las, .laz, .xyz/.csv, .bin (KITTI) and .feather
/// (sweeps of Argoverse 2, placed in the city by the poses beside them); the format is told by
/// content, and by suffix where content does not tell. No library sees the bytes, and no header
/// makes the reader allocate more than a small multiple of the file.
/// @throws InputError if the file is unusable or has no finite point.
PointCloud read_point_cloud(const std::filesystem::path& file);

/// The same of a file whose bytes have been read.
PointCloud point_cloud_of(const std::filesystem::path& file, std::string_view bytes,
                          const CloudFilter& filter = {});

/// The same from bytes, without what stands beside them. With a filter, what it
/// says of points by themselves and of the vehicle's box is done, and the cloud may hold no point;
/// `name` stands for the file in messages,
/// its suffix counts.
PointCloud parse_point_cloud(std::string_view bytes, const std::string& name,
                             const CloudFilter& filter = {});

}  // namespace roadbed::map::occupancy::clouds
