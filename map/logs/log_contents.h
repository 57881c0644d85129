#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "roadbed/map/logs/log.h"
#include "roadbed/map/logs/log_drive.h"
#include "roadbed/map/logs/log_gaps.h"

namespace roadbed::map::inline logs {

/// What a log holds of one topic, by the times at which messages were recorded.
struct TopicContents {
  LogTopic topic;
  std::size_t messages = 0;
  std::int64_t first_ns = 0, last_ns = 0;  ///< the earliest and the latest
  double rate_hz = 0.0;                    ///< of the median interval; 0: fewer than two messages
  std::vector<LogGap> gaps;                ///< longer than three median intervals
  std::size_t backwards = 0;               ///< messages recorded before the one in front of them
};

/// All topics, by name; 8 bytes of memory a message.
/// @throws InputError as read_log does.
std::vector<TopicContents> contents_of_log(const GoThrough& go_through);
std::vector<TopicContents> contents_of_log(const std::filesystem::path& path);

}  // namespace roadbed::map::logs
