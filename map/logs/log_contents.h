#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/map/logs/log.h"

namespace roadbed::map::inline logs {

/// A time without messages.
struct LogGap {
  std::int64_t from_ns, to_ns;
};

/// What a topic of transforms says of one frame in another.
struct FrameContents {
  std::string parent, child;
  std::size_t transforms = 0;
  double rate_hz = 0.0;      ///< of the median interval; 0: fewer than two transforms
  std::vector<LogGap> gaps;  ///< longer than three median intervals
};

/// What a log holds of one topic, by the times at which messages were recorded.
struct TopicContents {
  LogTopic topic;
  std::size_t messages = 0;
  std::int64_t first_ns = 0, last_ns = 0;  ///< the earliest and the latest
  /// Of the median interval; 0: fewer than two messages, or transforms of several frames, which
  /// come from several publishers and have rates of their own.
  double rate_hz = 0.0;
  std::vector<LogGap> gaps;   ///< longer than three median intervals; none without a rate
  std::size_t backwards = 0;  ///< messages recorded before the one in front of them
  std::vector<FrameContents> frames = {};  ///< of transforms that can be read, by parent and child
};

/// All topics, by name; 8 bytes of memory a message, and as many a transform.
/// @throws InputError as read_log does.
std::vector<TopicContents> contents_of_log(const GoThrough& go_through);
std::vector<TopicContents> contents_of_log(const std::filesystem::path& path);

/// Gaps of times in order, longer than three times the median interval, which is left in
/// `median_ns`; 0 of fewer than two.
std::vector<LogGap> gaps_in(const std::vector<std::int64_t>& times_ns, std::int64_t& median_ns);

}  // namespace roadbed::map::logs
