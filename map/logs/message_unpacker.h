#pragma once

// Private to map/logs.

#include <cstdint>
#include <string>
#include <string_view>

#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/logs/log_messages.h"

namespace roadbed::map::inline logs {

/// Unpacks messages that rosbag2 packed one by one (compression mode MESSAGE), in either storage.
class MessageUnpacker {
 public:
  MessageUnpacker(std::string file, std::uint64_t file_bytes);

  /// What a message holds: its own bytes where they are not packed; else valid until the next call.
  /// @throws InputError if it is damaged, or unpacks to more than the file is worth.
  std::string_view unpacked(const LogTopic& topic, std::string_view bytes,
                            const std::string& place);

 private:
  std::string file_, message_;
  std::uint64_t file_bytes_;
  geometry::WorkBudget left_;
};

}  // namespace roadbed::map::logs
