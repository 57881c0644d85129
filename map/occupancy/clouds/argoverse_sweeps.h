#pragma once

// Private to map/occupancy.

#include <filesystem>
#include <string>
#include <string_view>

#include "roadbed/map/occupancy/clouds/cloud_formats.h"
#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// A sweep of Argoverse 2, Feather with columns x, y and z: points in the vehicle's frame at the
/// time that its name says, whatever times they were measured at.
RawCloud parse_sweep(std::string_view bytes, const std::string& name, const CloudFilter& filter);

/// A sweep LOG/sensors/lidar/TIME.feather in the city's frame, by the pose at that time of
/// LOG/city_SE3_egovehicle.feather, with its time; as it is where there is no such file.
/// @throws InputError if those poses are unusable, or TIME lies before or after them.
PointCloud in_city(PointCloud sweep, const std::filesystem::path& file);

}  // namespace roadbed::map::occupancy::clouds
