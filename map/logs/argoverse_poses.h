#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/logs/pose_messages.h"

namespace roadbed::map::inline logs {

/// Where the vehicle was, its rear axle in the city: city_SE3_egovehicle.feather of Argoverse 2, in
/// the order of the file.
/// @throws InputError if it is damaged, has other columns, or a quaternion is no rotation to 1 %.
std::vector<TimedPose> read_ego_poses(std::string_view bytes, const std::string& name);

}  // namespace roadbed::map::logs
