#pragma once

// Private to map/occupancy.

#include <cstddef>
#include <string>

#include "roadbed/map/logs/cloud_message.h"
#include "roadbed/map/logs/log_poses.h"
#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// The cloud of a PointCloud2 message; its name is not set.
struct MessagePoints {
  PointCloud cloud;                     ///< may hold no point
  std::size_t without_pose = 0;         ///< points left out, as the sensor's pose is not known then
  std::size_t with_unlikely_times = 0;  ///< points that count as measured at the message's stamp
};

/// Takes the points off a message. With poses each is placed from where the sensor was when it was
/// measured, as fields t, time, timestamp or time_stamp say: whole numbers are nanoseconds, others
/// seconds, both from the message's stamp on, or since 1970 in s, ms, µs or ns by their magnitude;
/// and the sensor's position is known to 2 cm. Without poses they stand as they are.
/// @param pose_at  may be empty. @param file and `place` are for messages.
/// @throws InputError if it has no x, y and z, all float32 or all float64.
MessagePoints points_of_message(const CloudMessage& message, const PoseAt& pose_at,
                                const std::string& file, const std::string& place);

}  // namespace roadbed::map::occupancy::clouds
