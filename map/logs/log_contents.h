#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "roadbed/map/logs/log.h"

namespace roadbed::map::inline logs {

/// A time without messages.
struct LogGap {
  std::int64_t from_ns, to_ns;
};

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

/// Gaps of times in order, longer than three times the median interval, which is left in
/// `median_ns`; 0 of fewer than two.
std::vector<LogGap> gaps_in(const std::vector<std::int64_t>& times_ns, std::int64_t& median_ns);

}  // namespace roadbed::map::logs
