#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/logs/log_messages.h"

namespace roadbed::map::inline logs {

/// A value that each point has, as PointField of sensor_msgs says it.
struct PointField {
  std::string name;
  std::size_t offset;  ///< bytes before it in a point
  std::uint8_t type;   ///< 1 to 8: int8, uint8, int16, uint16, int32, uint32, float32, float64
};

/// sensor_msgs/msg/PointCloud2: points of one size, row after row.
struct CloudMessage {
  std::int64_t stamp_ns;  ///< of its header; where that is 0, when it was recorded
  std::string frame;
  std::size_t height, width;  ///< rows, and points of each
  std::vector<PointField> fields;
  bool is_big_endian;                ///< of the points, not of the message
  std::size_t point_step, row_step;  ///< bytes of a point, and of a row
  std::string_view data;             ///< holds all rows, each field of each point
};

bool is_cloud_type(std::string_view type);

/// Reads one, without looking at its points; valid as long as the message.
/// @throws InputError if it is cut off, or not all points and fields that it claims are there.
CloudMessage parse_cloud(const LogTopic& topic, const LogMessage& message, const std::string& file);

}  // namespace roadbed::map::logs
