#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace roadbed::map::inline logs {

/// A stream of messages of one type.
struct LogTopic {
  std::string name;      ///< "/localization/kinematic_state"
  std::string type;      ///< "nav_msgs/msg/Odometry"
  std::string encoding;  ///< of the messages: "cdr"
};

/// Whether a user who asks for a topic means this one: the slash in front may be left out.
inline bool is_asked_as(const std::string& topic, const std::string& asked) {
  return topic == asked || topic == "/" + asked;
}

/// Of topics leaves the one that is asked for: of that very name, else with a slash in front.
template <class Value>
void keep_asked(std::map<std::string, Value>& by_topic, const std::string& asked) {
  const std::string kept = by_topic.contains(asked) ? asked : "/" + asked;
  std::erase_if(by_topic, [&](const auto& entry) { return entry.first != kept; });
}

/// Whether differences of such times fit in 64 bits: those from 1824 to 2116.
constexpr bool is_usable_time(std::int64_t time_ns) {
  constexpr std::int64_t farthest_ns = std::int64_t{1} << 62;
  return time_ns > -farthest_ns && time_ns < farthest_ns;
}

/// A message as it was recorded.
struct LogMessage {
  std::int64_t received_ns;  ///< when it was recorded
  std::string_view bytes;    ///< valid until the next message
  std::string place;         ///< in the file, for messages
};

/// Who looks at a log. Topics of one name and type are asked for once.
struct LogVisitor {
  /// Whether messages of the topic are to be read; also asked for topics without any.
  std::function<bool(const LogTopic&)> wants;
  /// Takes them, in the order of the file.
  std::function<void(const LogTopic&, const LogMessage&)> take;
};

/// A log to go through, once.
using GoThrough = std::function<void(const LogVisitor&)>;

}  // namespace roadbed::map::logs
