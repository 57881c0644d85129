#pragma once

// Private to map/occupancy.

#include <cstddef>
#include <string>

#include "roadbed/map/logs/cloud_message.h"
#include "roadbed/map/logs/log_poses.h"
#include "roadbed/map/occupancy/clouds/cloud_filter.h"
#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// The cloud of a PointCloud2 message; its name is not set.
struct MessagePoints {
  PointCloud cloud;                     ///< may hold no point
  std::size_t without_pose = 0;         ///< points left out, as the sensor's pose is not known then
  std::size_t with_unlikely_times = 0;  ///< points that count as measured at the message's stamp
};

/// Where a message was measured from; each may be empty.
struct MessageFrames {
  PoseAt pose_at;     ///< of its frame in the world
  PoseAt in_vehicle;  ///< of its frame in that of the vehicle, which else is the same
};

/// Takes the points off a message. With poses each is placed from where the sensor was when it was
/// measured, as the fields of PointTime say: whole numbers are nanoseconds, others seconds, both
/// from the message's stamp on, or since 1970 in s, ms, µs or ns by their magnitude; and the
/// sensor's position is known to 2 cm. Without poses they stand as they are.
/// @param filter  of which attributes and the vehicle's box are looked at.
/// @param file    and `place` are for messages.
/// @throws InputError if it has no x, y and z, all float32 or all float64, or not what the filter
///         looks at.
MessagePoints points_of_message(const CloudMessage& message, const MessageFrames& frames,
                                const CloudFilter& filter, const std::string& file,
                                const std::string& place);

}  // namespace roadbed::map::occupancy::clouds
