#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace roadbed::map::inline logs {

/// A stream of messages of one type.
struct LogTopic {
  std::string name;      ///< "/localization/kinematic_state"
  std::string type;      ///< "nav_msgs/msg/Odometry"
  std::string encoding;  ///< of the messages: "cdr"
};

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

/// Whether the input is a log, by content: rosbag2 (an SQLite file, or a folder with a
/// metadata.yaml) or MCAP, also packed as files by Zstandard or gzip.
/// @throws InputError as read_file does.
bool is_log(const std::filesystem::path& path);

/// Goes through a log once. Of a plain file no more is in memory than a message, or a chunk of
/// MCAP; of packed files and streams all.
/// @throws InputError if it is damaged, cut off or no log, and what the visitor throws.
void read_log(const std::filesystem::path& path, const LogVisitor& visitor);

/// The same of the bytes of one file; `name` stands for it in messages.
void parse_log(std::string_view bytes, const std::string& name, const LogVisitor& visitor);

}  // namespace roadbed::map::logs
